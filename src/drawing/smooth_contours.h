// The contour of the smooth surface that a mesh of small triangles stands for.
//
// The mesh's own contour is a zigzag along its edges, which folds where the surface is saddle-shaped. The zero set of
// n · v, linear in each triangle between its corners' normals, runs on without branches (Hertzmann & Zorin 2000,
// "Illustrating Smooth Surfaces"), but lies on the mesh's facets, which hide it here and there. So it is lifted off
// them along the normal, by what facets can rise above it: outward of the mesh's outline where the surface is convex
// along the line of sight, and well within the surface where it is not. There it is hidden, as the smooth contour is.
#pragma once

#include "drawing/candidates.h"

namespace limn {

struct SmoothContours {
    std::vector<Candidate> lines;
    /// Of each component of the mesh: are its contours the smooth ones? They are where the lift stays below kMostLift
    /// and facets turn little against one another; coarser meshes keep their own, which is what the picture shows.
    std::vector<char> isSmooth;
};

/// In pixels.
inline constexpr double kMostLift = 0.5;

/// In the order of triangles, whatever the number of threads. Needs normals; without them nothing is smooth.
SmoothContours findSmoothContours(const ViewedScene& scene, const ViewedMesh& placed);

/// Do both triangles on an edge have the same normals at its ends?
bool isSmoothEdge(const ViewedMesh& placed, const TriangleEdge& edge);

}  // namespace limn
