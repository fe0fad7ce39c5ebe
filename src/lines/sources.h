// The sources of lines, that is, the reasons for a line: one row each. These rows give the parameters of techniques,
// the numbers of sources in shaders, the images that are compared, and the styles of strokes.
#pragma once

#include "picture/aov.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace limn {

struct LineSource {
    std::string_view name;       ///< of the parameter that weighs its lines
    std::string_view colorName;  ///< of the parameter that colours them
    std::string_view define;     ///< its number in shaders; WITH_ before it means that such lines are looked for
    float weight;                ///< default of its lines, in widths
    std::string_view doc, colorDoc;
    std::string_view sampler;       ///< shaders' name of the image that is compared, beyond depth and face
    const Aov* compares = nullptr;  ///< that image; null: depth and face are enough
    enum class Only { always, cutOpen, withMarks };
    Only only = Only::always;  ///< which scenes have it: those that are cut open, or with lines of their own
};

/// Where several reasons hold, sections count before silhouettes, then objects, materials and creases
/// (depth_normal.comp). Marks are no difference between pixels (effects/edges/marks.h).
inline constexpr LineSource kLineSources[] = {
    {"silhouettes", "silhouette_color", "SILHOUETTE", 1,
        "Weight of lines where one surface ends in front of another or of nothing; at 0 there are none.",
        "Colour of those lines, or \"same\" as `color`.", ""},
    {"creases", "crease_color", "CREASE", 1, "Weight of lines where a surface bends.",
        "Colour of lines where a surface bends.", "normal", &aov::normal},
    {"objects", "object_color", "OBJECT", 0, "Weight of lines where objects touch.",
        "Colour of lines where objects touch.", "objectId", &aov::objectId},
    {"materials", "material_color", "MATERIAL", 0, "Weight of lines where materials meet.",
        "Colour of lines where materials meet.", "materialId", &aov::materialId},
    {"sections", "section_color", "SECTION", 2, "Weight of lines around the cut faces of sections.",
        "Colour of lines around cut faces.", "", nullptr, LineSource::Only::cutOpen},
    {"marks", "mark_color", "MARK", 1, "Weight of lines that mesh files draw themselves (an OBJ's l).",
        "Colour of lines that mesh files draw.", "", nullptr, LineSource::Only::withMarks},
};
inline constexpr std::size_t kLineSourceCount = std::size(kLineSources);

/// The row of the source with this define. Its number in shaders is one more; 0 is no line.
constexpr std::size_t lineSource(std::string_view define) {
    for (std::size_t i = 0; i < kLineSourceCount; ++i)
        if (kLineSources[i].define == define) return i;
    throw "no such source of lines";
}

/// One value for each source.
template <class T>
using PerSource = std::array<T, kLineSourceCount>;

constexpr PerSource<float> standardWeights() {
    PerSource<float> weights{};
    for (std::size_t i = 0; i < kLineSourceCount; ++i) weights[i] = kLineSources[i].weight;
    return weights;
}

}  // namespace limn
