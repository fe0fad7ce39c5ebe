// What is in a mesh file, for people and programs.
#pragma once

#include "formats/format.h"
#include "mesh/subdivide.h"
#include "mesh/topology.h"

namespace limn {

struct MeshFacts {
    std::string file;
    std::size_t faces = 0, triangles = 0, quads = 0, largerFaces = 0, uvs = 0, normals = 0, lines = 0;
    std::vector<std::string> materials, parts;
    std::size_t creases = 0, infiniteCreases = 0, corners = 0, holes = 0;
    Bounds bounds;
    TopologyReport topology;
    std::size_t covered = 0;            ///< triangles that lie on earlier ones in the same plane
    std::vector<MeshWarning> warnings;  ///< in the order of lines; those of repairs have no line
    std::string subdivision;            ///< what Catmull-Clark at level 2 would do
};

/// Reads, repairs and looks. Throws what reading throws.
MeshFacts inspectMesh(const std::filesystem::path& path);

std::string meshFactsText(const MeshFacts& facts);
std::string meshFactsJson(const MeshFacts& facts);

}  // namespace limn
