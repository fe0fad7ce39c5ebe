#include "effects/technique.h"

#include "base/text.h"
#include "settings/document.h"
#include "stage/shadow_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

std::vector<const Technique*>& registry() {
    static std::vector<const Technique*> techniques;
    return techniques;
}

std::vector<std::string> namesIn(std::string_view slot) {
    std::vector<std::string> names;
    for (const auto* technique : allTechniques())
        if (technique->slot == slot) names.emplace_back(technique->name);
    return names;
}

}  // namespace

Technique::Technique(std::string_view slot_, std::string_view name_, std::string_view doc_, Schema schema_,
    std::vector<Preset>&& presets_)
    : slot(slot_), name(name_), doc(doc_), schema(schema_), presets(std::move(presets_)) {
    registry().push_back(this);
}

const std::vector<const Technique*>& allTechniques() {
    // The linker's order is arbitrary: sort once, after all have registered.
    static const bool sorted = [] {
        std::sort(registry().begin(), registry().end(),
            [](const auto* a, const auto* b) { return std::pair(a->slot, a->name) < std::pair(b->slot, b->name); });
        return true;
    }();
    static_cast<void>(sorted);
    return registry();
}

const Technique* findTechnique(std::string_view slot, std::string_view name) {
    for (const auto* technique : allTechniques())
        if (technique->slot == slot && technique->name == name) return technique;
    return nullptr;
}

ResourceId EffectBuilder::read(const Aov& aov) const {
    if (const auto found = find(aov)) return *found;
    throw Error(ExitCode::internal, {},
        fmt::format("{} '{}' reads '{}', which nothing before it writes", slot_, technique_, aov.name),
        "please report this");
}

std::optional<ResourceId> EffectBuilder::find(const Aov& aov) const {
    const auto it = published_.find(aov.name);
    if (it == published_.end()) return std::nullopt;
    return it->second;
}

const TechniqueChoice* EffectBuilder::chosen(const Technique& technique) const {
    for (const auto* choice : choices_)
        if (choice->technique == &technique) return choice;
    return nullptr;
}

void EffectBuilder::beginTechnique(const Slot& slot, std::string_view technique, int layer) {
    beginPasses(std::string(slot.name), std::string(technique), slot.rate ? slot.rate(view_) : kEverySample);
    layer_ = slot.fill == Slot::Fill::layers ? layer : 0;
}

void EffectBuilder::beginPasses(std::string slot, std::string technique, int rate) {
    slot_ = std::move(slot);
    technique_ = std::move(technique);
    rate_ = rate;
}

ResourceId EffectBuilder::image(std::string name, Format format, int coarseness) {
    return graph_.add({std::move(name), format, (view_.region.size + coarseness - 1) / coarseness, false});
}

ResourceId EffectBuilder::fineImage(std::string name, Format format) {
    usesFineRaster_ = true;
    return graph_.add({std::move(name), format, view_.canvas.size * view_.sampling.raster, false});
}

void EffectBuilder::add(Pass pass) {
    pass.slot = slot_;
    pass.technique = technique_;
    if (pass.shader.empty()) pass.shader = fmt::format("effects/{}/{}", slot_, technique_);
    if (pass.rate == kEverySample) pass.rate = rate_;
    if (pass.rate >= view_.sampling.samples()) pass.rate = kEverySample;  // nothing need be kept
    graph_.passes.push_back(std::move(pass));
}

void EffectBuilder::cutHoles(Pass& pass) const {
    if (!scene_.cutouts) return;
    pass.defines.emplace_back("CUTOUTS", "");
    pass.needs = pass.needs | SceneData::uvs | SceneData::materials | SceneData::textures;
}

void EffectBuilder::defineSeen(Pass& pass) const {
    if (scene_.triangleBits > 0) pass.defines.emplace_back("TRIANGLE_BITS", std::to_string(scene_.triangleBits));
}

void EffectBuilder::seedNoise(Pass& pass) const {
    if (!view_.noiseOnSurface) return;
    const auto place = find(aov::surfacePlace);
    if (!place)
        throw Error(ExitCode::usage, {}, "image.seed = \"surface\" goes with the exact geometry only",
            "leave accuracy out, or give image.seed a number");
    pass.reads.push_back({"surfacePlace", *place});
    pass.defines.emplace_back("NOISE_ON_SURFACE", "");
}

bool EffectBuilder::isUnified() const {
    return std::any_of(graph_.passes.begin(), graph_.passes.end(),
        [](const Pass& pass) { return has(pass.needs, SceneData::unifiedVertices); });
}

std::optional<ResourceId> EffectBuilder::shadowMaps() {
    if (shadowMaps_) return shadowMaps_;
    const ShadowLayout layout = shadowLayout(scene_.lights);
    if (layout.maps.empty()) return std::nullopt;
    shadowMaps_ = graph_.add({"shadow_maps", Format::depth32f, layout.size, true});
    Pass pass;
    pass.name = "shadow_maps";
    pass.slot = "shadow";
    pass.technique = "shadow_map";
    pass.kind = Pass::Kind::raster;
    pass.rate = view_.sampling.samples() == 1 || view_.isBlurred ? kEverySample : 1;
    pass.shader = "scene/shadow_map";
    pass.writes = {{"shadowDepth", *shadowMaps_}};
    pass.needs = SceneData::positions | SceneData::shadows;
    pass.isOfLights = true;
    cutHoles(pass);
    if (scene_.cutouts && isUnified()) pass.defines.emplace_back("UNIFIED", "");
    for (const auto& map : layout.maps)
        pass.rasterViews.push_back({map.viewport, static_cast<int>(pass.rasterViews.size())});
    pass.defines.emplace_back("MAP_COUNT", std::to_string(layout.maps.size()));
    pass.note = fmt::format("{} map{}", layout.maps.size(), layout.maps.size() == 1 ? "" : "s");
    graph_.passes.push_back(std::move(pass));
    return shadowMaps_;
}

std::shared_ptr<void> TechniqueChoice::at(double frame) const {
    auto copy = technique->copyParams(params.get());
    applyTracks(copy.get(), tracks, frame);
    return copy;
}

TechniqueChoice defaultChoice(std::string_view slot, std::string_view name) {
    const Technique* technique = findTechnique(slot, name);
    if (!technique)
        throw Error(
            ExitCode::internal, {}, fmt::format("there is no {} technique '{}'", slot, name), "please report this");
    return {technique, technique->makeParams(), {}};
}

void applySettings(TechniqueChoice& choice, std::string_view settings) {
    ErrorCollector errors;
    const Node table = *parseDocument(fmt::format("settings = {{ {} }}", settings), "settings").find("settings");
    readFields(table, choice.technique->schema, choice.params.get(), &choice.tracks,
        fmt::format("{} '{}'", choice.technique->slot, choice.technique->name), errors);
    errors.throwIfAny();
}

namespace {

/// The presets that `mode` and `preset` of a table name. The table's own settings override them.
void readPresets(const Node& table, std::string_view what, TechniqueChoice& choice, ErrorCollector& errors) {
    const Technique& technique = *choice.technique;
    const auto apply = [&](const Node& node, std::string_view wanted) {
        std::vector<std::string> names;
        for (const auto& preset : technique.presets) {
            if (preset.name == wanted) return applySettings(choice, preset.settings);
            names.emplace_back(preset.name);
        }
        errors.add({ExitCode::usage, node.where,
            fmt::format("{} technique '{}' has no preset '{}'", technique.slot, technique.name, wanted),
            names.empty() ? "it has none" : nameRemedy(wanted, names)});
    };
    if (const Node* mode = table.find("mode")) {
        const std::string* text = mode->text();
        if (!text || (*text != "default" && *text != "paper"))
            errors.add(
                {ExitCode::usage, mode->where, fmt::format("'mode' in {} must be \"default\" or \"paper\"", what), ""});
        else if (*text == "paper")
            apply(*mode, "paper");
    }
    if (const Node* preset = table.find("preset")) {
        if (preset->text())
            apply(*preset, *preset->text());
        else
            errors.add({ExitCode::usage, preset->where, fmt::format("'preset' in {} must be text", what), ""});
    }
}

}  // namespace

TechniqueChoice readChoice(const Node& table, const Slot& slot, std::string_view what, ErrorCollector& errors,
    std::span<const std::string_view> alsoKnown) {
    TechniqueChoice choice;
    if (!table.isTable() && !table.text()) {
        errors.add(
            {ExitCode::usage, table.where, fmt::format("{} must be a table, not {}", what, table.kindName()), ""});
        return choice;
    }
    // A technique without settings may be given by its name alone.
    const Node* named = table.text() ? &table : table.find("technique");
    const std::string name = named && named->text() ? *named->text() : "";
    choice.technique = findTechnique(slot.name, name);
    if (!choice.technique) {
        const auto names = namesIn(slot.name);
        if (!named)
            errors.add({ExitCode::usage, table.where, fmt::format("{} has no 'technique'", what),
                "it can be " + joinOr(names)});
        else
            errors.add({ExitCode::usage, named->where, fmt::format("there is no {} technique '{}'", slot.name, name),
                nameRemedy(name, names)});
        return choice;
    }
    choice.params = choice.technique->makeParams();
    if (table.text()) return choice;
    readPresets(table, what, choice, errors);
    std::vector<std::string_view> known{"technique", "mode", "preset"};
    known.insert(known.end(), alsoKnown.begin(), alsoKnown.end());
    readFields(table, choice.technique->schema, choice.params.get(), &choice.tracks, fmt::format("{} ({})", what, name),
        errors, known);
    return choice;
}

}  // namespace limn
