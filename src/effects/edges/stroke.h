// From where lines run to lines of a width: what every edge technique ends with.
#pragma once

#include "effects/technique.h"

namespace limn {

/// How lines look, in a technique's parameters.
struct Stroke {
    PictureLength width;
    Color color;
    float opacity = 1;
};

/// Adds the passes that draw lines along the sides of pixels in `sides` (an R8 image, see shaders/lib/stroke.glsl), over the layers
/// before, and publishes `edges`. Half of the width lies on each side; the distance to the line is Euclidean, so that the width is the
/// same in every direction and ends are round.
void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke);

}  // namespace limn
