// Subdivision surfaces through OpenSubdiv: the limit surface as triangles, or the refined polygons.
//
// There are three ways. Bfr evaluates the limit surface face by face, in parallel, with a rate of its own for each
// edge. The first face on a vertex or edge evaluates its points, and the others share them: there are no cracks. Far's
// adaptive patches do the same for connected components that have an interior vertex of two faces, where Bfr 3.5 writes
// out of bounds. Far's uniform refinement serves plain refinement and Chaikin creases (where Bfr cracks by 5e-4 of the
// diagonal), and is the tests' oracle.
#pragma once

#include "mesh/tri_mesh.h"

#include <functional>
#include <string>

namespace limn {

enum class SubdivisionScheme { catmullClark, loop, bilinear };
enum class BoundaryRule { none, edgeOnly, edgeAndCorner };
enum class UvRule { none, cornersOnly, cornersPlus1, cornersPlus2, boundaries, all };

struct SubdivisionOptions {
    SubdivisionScheme scheme = SubdivisionScheme::catmullClark;
    int level = 2;      ///< halvings of every edge; with edgeRate their maximum
    bool limit = true;  ///< onto the limit surface; else the points of plain refinement
    BoundaryRule boundary = BoundaryRule::edgeAndCorner;  ///< of the rims of open meshes
    UvRule uv = UvRule::boundaries;                       ///< where texture coordinates stay linear
    bool chaikin = false;
    bool smoothTriangles = false;
    bool safe = false;  ///< uniform refinement for everything: the slower way, and an independent oracle
    /// Segments of a cage edge, given its ends; empty: 2^level for every edge. Called from many threads.
    std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRate;
};

/// Sharpness from which a crease or corner is infinitely sharp.
inline constexpr float kInfiniteSharpness = 10;

/// The given options, overridden by a file's own tags.
SubdivisionOptions withTags(SubdivisionOptions options, const SubdivisionTags& tags);

struct SubdivisionReport {
    std::size_t faces = 0;  ///< of the cage
    std::size_t components = 0;
    std::size_t safeComponents = 0;  ///< took uniform refinement
    std::size_t safeFaces = 0;
    std::string safeReason;          ///< of those; "" when none
    std::size_t plainFaces = 0;      ///< that OpenSubdiv cannot take at all; drawn as they are
    std::size_t missingCreases = 0;  ///< on edges that do not exist; ignored
    std::size_t splitFaces = 0;      ///< cut into triangles: n-gons for Loop, and faces that meet themselves
};

/// How a mesh would be subdivided.
SubdivisionReport planSubdivision(const PolyMesh& cage, const SubdivisionOptions& options);

/// The same in words: "catmull-clark, level 3, limit surface, …".
std::string describe(const SubdivisionOptions& options, const std::string& edgeLength, const SubdivisionReport& report);

/// The surface as triangles. The cage must have been through repairTopology. Normals are exact where the surface is
/// smooth and one per side at infinitely sharp creases; never zero unless all triangles around are. Parallel; the
/// result does not depend on threads. Throws Error (badData) naming `name` when OpenSubdiv takes nothing of it.
TriMesh subdivide(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs,
    const std::string& name, SubdivisionReport* report = nullptr);

/// Uniform refinement by Far: polygons, with UVs and, where wanted, normals; on the limit surface or not.
PolyMesh refineUniformly(const PolyMesh& cage, const SubdivisionOptions& options, bool wantNormals = true);

}  // namespace limn
