// From where lines run to lines of a width: what every edge technique ends with.
#pragma once

#include "effects/technique.h"

namespace limn {

/// Which side of the surface that it bounds a line lies on.
enum class LineSide { both, inner, outer };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<LineSide> = {"both", "inner", "outer"};

/// How lines of one source look.
struct LineStyle {
    double width = 0;  ///< pixels of the output
    Color color;
    bool operator==(const LineStyle&) const = default;
};

/// Everything about how lines look, in the order of shaders/lib/lines.glsl.
struct Stroke {
    LineStyle silhouette, crease, object, material, section;
    float opacity = 1;
    LineSide side = LineSide::both;
    double fade = 0, taper = 0;       ///< of opacity and width, lost with depth
    double fadeFrom = 0, fadeTo = 1;  ///< normalized units: where they begin to, and have
};

/// How often lines must be found: where the triangles seen tell how they run, each sample finds them in the same place;
/// else samples differ, and all are needed for smooth borders.
inline int lineRate(const EffectBuilder& graph) {
    return graph.find(aov::visibility) ? graph.view().lineSamples : kEverySample;
}

/// Adds the passes that draw lines between the pixels that `sides` names (an R32UI image, see shaders/lib/lines.glsl),
/// over the layers before, and publishes `edges`. Where exactly a line runs is computed from the triangles seen, where
/// the geometry knows them. Widths are Euclidean, the same in every direction and at every number of samples; ends are
/// round. Objects and materials may have colours of their own.
void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke);

}  // namespace limn
