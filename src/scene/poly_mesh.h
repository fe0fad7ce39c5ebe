// A polygon mesh as a file gives it: faces of any size, and UVs and normals with indices of their own.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

struct PolyMesh {
    static constexpr std::int32_t kNone = -1;

    std::vector<glm::dvec3> positions;      ///< file units
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> normals;         ///< as given: not necessarily unit length

    std::vector<std::uint32_t> faceStart{0};         ///< faces + 1 entries; corners of face f are [faceStart[f], faceStart[f+1]), three or more
    std::vector<std::uint32_t> cornerPosition;       ///< index into positions, always valid
    std::vector<std::int32_t> cornerUv;              ///< index into uvs or kNone; empty when the mesh has no uvs
    std::vector<std::int32_t> cornerNormal;          ///< index into normals or kNone; empty when the mesh has no normals

    std::vector<std::uint32_t> faceMaterial;         ///< index into materialNames
    std::vector<std::uint32_t> facePart;             ///< index into partNames: the OBJ's objects and groups
    std::vector<std::uint32_t> faceSmoothing;        ///< smoothing group; 0 = flat
    bool hasSmoothing = false;                       ///< the file speaks of smoothing at all; else smooth by angle

    std::vector<std::string> materialNames;          ///< "" = no material named
    std::vector<std::string> partNames;
    std::vector<std::string> materialLibraries;      ///< arguments of each mtllib line, in order, not yet split

    std::size_t faceCount() const { return faceStart.size() - 1; }
};

/// Something odd that was mended while reading: one entry per kind.
struct MeshWarning {
    std::string kind;      ///< "face refers to a vertex that does not exist; dropped"
    std::size_t count = 0;
    int firstLine = 0;
};

}  // namespace limn
