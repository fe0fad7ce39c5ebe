// The best result that a depth buffer allows: rays against the buffer's own triangles.
#pragma once

#include "rays/ray_scene.h"

namespace limn {

/// Where a pixel's surface lies, in normalized view space; `z`: its depth there. `y` counts from the top.
glm::dvec3 placeOf(const View& view, int x, int y, double z);
/// Does one of two neighbours lie on the other's tangent plane, to within one width of a pixel? `normals`: view space.
bool areJoined(const View& view, const glm::dvec3& a, const glm::dvec3& b, const float* normalA, const float* normalB);

/// A depth buffer as an open shell. Neighbouring pixels become triangles where one lies on the other's tangent plane,
/// to within one width of a pixel; elsewhere there is nothing. (One is enough: the sides of a corner have different
/// slants, and only one of them lies near.) `depth` and `normals` (view space, three per pixel, rows from the upper
/// left) are of `view`'s region.
std::unique_ptr<RayScene> buildShell(
    const View& view, const SceneInfo& scene, std::span<const float> depth, std::span<const float> normals);

}  // namespace limn
