// Shared code of the ambient occlusion techniques: resolution and the names of their results.
#pragma once

#include "effects/technique.h"
#include "rays/falloff.h"

namespace limn {

enum class Resolution { full, half };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<Resolution> = {"full", "half"};

/// The images that a technique compares, at its resolution.
struct OcclusionInputs {
    ResourceId depth;    ///< at the technique's resolution
    ResourceId normal;   ///< geometric, always at full resolution
    int coarseness = 1;  ///< pixels of the picture per texel, each way
};

/// Gets the inputs. Half resolution adds a pass that picks every second depth.
OcclusionInputs occlusionInputs(EffectBuilder& graph, Resolution resolution);

/// The image that a technique writes.
ResourceId occlusionImage(EffectBuilder& graph, const OcclusionInputs& inputs);

/// Publishes the image as the picture's ambient occlusion. Half resolution first adds a pass that upsamples it: each
/// pixel from the four nearest texels, weighted by how well they lie in the pixel's plane (joint bilateral upsampling,
/// Kopf et al. 2007).
void publishOcclusion(EffectBuilder& graph, const OcclusionInputs& inputs, ResourceId image);

/// Adds the defines of every technique's shader: COARSENESS, FALLOFF.
void defineOcclusion(Pass& pass, const OcclusionInputs& inputs, Falloff falloff);

}  // namespace limn
