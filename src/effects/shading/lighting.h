// Shared code of the shading techniques that evaluate lights.
#pragma once

#include "effects/technique.h"

namespace limn {

/// The kind of highlights: none, from each material's shininess, or all alike.
enum class Highlights { none, ofMaterials, alike };

/// Lets the pass's shader include scene/lighting.glsl: adds its reads and their defines. It reads depth and normal;
/// material_id where drawn materials have highlights; shadow maps and normal_geometric where a light casts shadows;
/// ambient_occlusion where there is any and `aoStrength` is above 0. So the shader computes nothing that the scene does
/// not have.
void readLighting(EffectBuilder& graph, Pass& pass, float aoStrength, Highlights highlights);

/// Adds a pass of the technique's own shader that lights the objects' colours, and publishes its result as the shade.
void addLitShading(
    EffectBuilder& graph, std::string name, UniformBlock params, float aoStrength, Highlights highlights);

}  // namespace limn
