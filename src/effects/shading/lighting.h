// What shading techniques that evaluate lights have in common.
#pragma once

#include "effects/technique.h"

namespace limn {

/// Lets the pass's shader include frame/lighting.glsl: adds the reads (depth, normal, material_id; shadow maps and normal_geometric where a
/// light casts shadows; ambient_occlusion where there is any and `aoStrength` is above 0) and the defines that go with them.
void readLighting(EffectBuilder& graph, Pass& pass, float aoStrength);

}  // namespace limn
