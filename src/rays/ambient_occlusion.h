// Ambient occlusion by ray tracing: the ground truth for every other technique.
//
//     A(p) = 1 − (1/π) ∫ V(ω) · w(d) · cos θ dω      over the hemisphere around the geometric normal,
//
// V = 1 where geometry is hit at a distance d ≤ R. Directions are cosine-weighted, so that A is the mean of 1 − V·w
// over rays.
#pragma once

#include "rays/falloff.h"
#include "rays/ray_scene.h"

#include <span>

namespace limn {

struct OcclusionQuery {
    double radius = 1;  ///< R, normalized units
    Falloff falloff = Falloff::none;
    int rays = 4;  ///< per pixel
};

/// The visible surfaces of a view, as read back: rows from the lower left, of view.region.size.
struct SeenSurfaces {
    std::span<const float> depth;            ///< normalized units; kBackgroundDepth where nothing is
    std::span<const float> normalGeometric;  ///< two octahedral coordinates per pixel (shaders/lib/normals.glsl)
};

/// Writes A of every pixel of `part` (of the region drawn) to `visibility` (background 1), and its standard error to
/// `error` (background 0), each unless it is empty. The error is the spread of independent groups of rays where there
/// are enough, else that of as many independent hits. In parallel; the result does not depend on threads. Origins are
/// lifted off their surface by a few roundings of their coordinates and of their depth.
void traceAmbientOcclusion(const RayScene& scene, const View& view, const SeenSurfaces& surfaces,
    const OcclusionQuery& query, const PixelRect& part, std::span<float> visibility, std::span<float> error);

}  // namespace limn
