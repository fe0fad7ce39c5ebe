#include "effects/slot.h"

#include <fmt/format.h>

namespace limn {

std::span<const Slot> allSlots() {
    static const Slot slots[] = {
        {.name = "geometry",
            .key = "accuracy",
            .fallback = "exact",
            .promises = {&aov::depth, &aov::normal, &aov::normalGeometric, &aov::position, &aov::albedo, &aov::objectId,
                &aov::materialId},
            .doc = "Which surface each pixel shows."},
        {.name = "ao",
            .key = "ao",
            .promises = {&aov::ambientOcclusionRaw, &aov::ambientOcclusion},
            .rate = [](const View& view) { return view.aoSamples; },
            .doc = "Ambient occlusion: how open each surface is to light from everywhere."},
        {.name = "filter",
            .key = "ao.filter",
            .fill = Slot::Fill::chain,
            .promises = {&aov::ambientOcclusion},
            .worksOn = &aov::ambientOcclusion,
            .rate = [](const View& view) { return view.aoSamples; },
            .doc = "Smooths ambient occlusion."},
        {.name = "shading",
            .key = "shading",
            .fallback = "flat",
            .promises = {&aov::shade},
            .doc = "Colours surfaces."},
        {.name = "edges",
            .key = "edges",
            .fill = Slot::Fill::layers,
            .promises = {&aov::edges},
            .doc = "Lines, in layers."},
        {.name = "composite",
            .key = "composite",
            .fallback = "over",
            .promises = {&aov::beauty},
            .doc = "Puts the picture together."},
    };
    return slots;
}

const Slot* findSlot(std::string_view name) {
    for (const auto& slot : allSlots())
        if (slot.name == name) return &slot;
    return nullptr;
}

std::string_view Slot::parent() const {
    const auto dot = key.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : key.substr(0, dot);
}

std::string_view Slot::ownKey() const {
    const auto dot = key.rfind('.');
    return dot == std::string_view::npos ? key : key.substr(dot + 1);
}

std::string Slot::label() const {
    if (!parent().empty()) return fmt::format("{} of [{}]", ownKey(), parent());
    return fill == Fill::layers ? fmt::format("[[{}]]", key) : fmt::format("[{}]", key);
}

}  // namespace limn
