#include "job/flicker.h"

#include "settings/color.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

const Layer* find(std::span<const Layer> layers, std::string_view name) {
    for (const auto& layer : layers)
        if (layer.name == name) return &layer;
    return nullptr;
}

void append(Image& to, const Image& rows) {
    to.width = rows.width;
    to.channels = rows.channels;
    to.height += rows.height;
    to.pixels.insert(to.pixels.end(), rows.pixels.begin(), rows.pixels.end());
}

/// Rec. 709's weights, display-encoded.
Image luminanceOf(const Image& beauty) {
    Image result{beauty.width, beauty.height, 1, {}};
    for (int y = 0; y < beauty.height; ++y)
        for (int x = 0; x < beauty.width; ++x) {
            const float* c = beauty.at(x, y);
            result.pixels.push_back(
                linearToSrgb(std::clamp(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2], 0.0f, 1.0f)));
        }
    return result;
}

}  // namespace

bool Flicker::canBeSeen(std::span<const Layer> layers) {
    return find(layers, "beauty") && find(layers, "motion") && find(layers, "object_id");
}

void Flicker::add(std::span<const Layer> band) {
    append(now_.luminance, luminanceOf(find(band, "beauty")->image));
    append(now_.motion, find(band, "motion")->image);
    append(now_.object, find(band, "object_id")->image);
}

std::optional<FlickerFigure> Flicker::endFrame() {
    std::vector<float> changes;
    const Image& was = before_.luminance;
    for (int y = 0;
         y < now_.luminance.height && was.width == now_.luminance.width && was.height == now_.luminance.height; ++y)
        for (int x = 0; x < now_.luminance.width; ++x) {
            const float object = *now_.object.at(x, y);
            const float* motion = now_.motion.at(x, y);
            // Upwards in the picture is towards the first row.
            const float px = static_cast<float>(x) - motion[0], py = static_cast<float>(y) + motion[1];
            if (object == 0
                || !(px >= 0 && py >= 0 && px <= static_cast<float>(was.width - 1)
                    && py <= static_cast<float>(was.height - 1)))
                continue;
            const int left = std::min(static_cast<int>(px), was.width - 2),
                      top = std::min(static_cast<int>(py), was.height - 2);
            const float u = px - static_cast<float>(left), v = py - static_cast<float>(top);
            float before = 0;
            bool isSeen = left >= 0 && top >= 0;
            for (int k = 0; k < 4 && isSeen; ++k) {
                const int qx = left + k % 2, qy = top + k / 2;
                isSeen = *before_.object.at(qx, qy) == object;
                before += *was.at(qx, qy) * (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
            }
            if (isSeen) changes.push_back(255 * std::abs(*now_.luminance.at(x, y) - before));
        }
    const double pixels = static_cast<double>(now_.luminance.pixels.size());
    before_ = std::move(now_);
    now_ = {};
    if (changes.empty()) return std::nullopt;
    FlickerFigure figure;
    for (const float change : changes) figure.mean += change / static_cast<double>(changes.size());
    const auto at = changes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(changes.size() - 1));
    std::nth_element(changes.begin(), at, changes.end());
    figure.p99 = *at;
    figure.compared = static_cast<double>(changes.size()) / pixels;
    return figure;
}

}  // namespace limn
