// The last step of every edge technique: places of lines become lines of a width.
#pragma once

#include "effects/technique.h"
#include "lines/style.h"

namespace limn {

/// The rate of finding lines. The visible triangles, where known, give every sample the same lines. Else samples
/// differ, and smooth borders need all of them.
inline int lineRate(const EffectBuilder& graph) {
    return graph.find(aov::visibility) ? graph.view().lineSamples : kEverySample;
}

/// Defines the numbers of all sources of lines for the pass's shaders.
void defineSources(Pass& pass);

/// Adds the passes that draw the lines of `sides` (an R32UI image, see shaders/lib/lines.glsl) over the layers before,
/// and publishes `edges`. The visible triangles give a line's exact place, where the geometry knows them. Widths are
/// Euclidean, the same in every direction and at every number of samples; ends are round. Objects and materials may
/// have colours of their own. `marks`: images of further pieces (effects/edges/marks.h).
void strokeLines(
    EffectBuilder& graph, ResourceId sides, const Stroke& stroke, const std::vector<ResourceId>& marks = {});

}  // namespace limn
