// From where lines run to lines of a width: what every edge technique ends with.
#pragma once

#include "effects/technique.h"
#include "lines/style.h"

namespace limn {

/// How often lines must be found: where the triangles seen tell how they run, each sample finds them in the same place;
/// else samples differ, and all are needed for smooth borders.
inline int lineRate(const EffectBuilder& graph) {
    return graph.find(aov::visibility) ? graph.view().lineSamples : kEverySample;
}

/// Lets the pass's shaders know the numbers of all sources of lines.
void defineSources(Pass& pass);

/// Adds the passes that draw lines between the pixels that `sides` names (an R32UI image, see shaders/lib/lines.glsl),
/// over the layers before, and publishes `edges`. Where exactly a line runs is computed from the triangles seen, where
/// the geometry knows them. Widths are Euclidean, the same in every direction and at every number of samples; ends are
/// round. Objects and materials may have colours of their own.
void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke);

}  // namespace limn
