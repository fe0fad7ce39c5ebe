// What shading techniques that evaluate lights have in common.
#pragma once

#include "effects/technique.h"

namespace limn {

/// How highlights are made, if at all: from each material's shininess, or all alike.
enum class Highlights { none, ofMaterials, alike };

/// Lets the pass's shader include scene/lighting.glsl: adds the reads (depth, normal; material_id where materials that
/// are drawn have highlights; shadow maps and normal_geometric where a light casts shadows; ambient_occlusion where
/// there is any and `aoStrength` is above 0) and the defines that go with them, so that nothing is computed that the
/// scene does not have.
void readLighting(EffectBuilder& graph, Pass& pass, float aoStrength, Highlights highlights);

/// A pass of the slot's own shader that lights the objects' colours, and publishes what it makes as the shade.
void addLitShading(
    EffectBuilder& graph, std::string name, UniformBlock params, float aoStrength, Highlights highlights);

}  // namespace limn
