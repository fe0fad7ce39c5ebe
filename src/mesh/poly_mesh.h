// A polygon mesh as a file gives it: faces of any size, and UVs and normals with indices of their own.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace limn {

/// What a file says about subdivision: OpenSubdiv's `t` tags or a sidecar. Sharpness 10 and more is infinite.
struct SubdivisionTags {
    struct Crease {
        std::uint32_t a, b;
        float sharpness;
        bool operator==(const Crease&) const = default;
    };  ///< of the edge between two positions
    struct Corner {
        std::uint32_t vertex;
        float sharpness;
        bool operator==(const Corner&) const = default;
    };
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<std::uint32_t> holes;        ///< faces that are subdivided but not drawn, ascending
    std::optional<int> boundary;             ///< as in the file: 0 none, 1 edge and corner, 2 edge only
    std::optional<int> faceVaryingBoundary;  ///< 0…5: none, corners only, plus 1, plus 2, boundaries, all
    std::optional<bool> chaikin;
    std::optional<bool> smoothTriangles;

    bool operator==(const SubdivisionTags&) const = default;
    bool empty() const { return *this == SubdivisionTags{}; }
};

/// A straight line that a mesh file draws: part of an OBJ's `l` element.
struct MeshLine {
    glm::dvec3 a{0}, b{0};                 ///< file units
    std::uint32_t material = 0, part = 0;  ///< as of faces
};

struct PolyMesh {
    static constexpr std::int32_t kNone = -1;

    std::vector<glm::dvec3> positions;  ///< file units
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> colors;   ///< of each position, linear Rec.709; empty when no vertex has one
    std::vector<glm::vec3> normals;  ///< as given: not necessarily unit length

    std::vector<std::uint32_t> faceStart{
        0};  ///< faces + 1 entries; corners of face f are [faceStart[f], faceStart[f+1]), three or more
    std::vector<std::uint32_t> cornerPosition;  ///< index into positions, always valid
    std::vector<std::int32_t> cornerUv;         ///< index into uvs or kNone; empty when the mesh has no uvs
    std::vector<std::int32_t> cornerNormal;     ///< index into normals or kNone; empty when the mesh has no normals

    std::vector<std::uint32_t> faceMaterial;   ///< index into materialNames
    std::vector<std::uint32_t> facePart;       ///< index into partNames: the OBJ's objects and groups
    std::vector<std::uint32_t> faceSmoothing;  ///< smoothing group; 0 = flat
    bool hasSmoothing = false;                 ///< the file mentions smoothing; else smooth by angle

    std::vector<MeshLine> lines;  ///< in the file's order, those of a polyline one after the other

    SubdivisionTags tags;

    std::vector<std::string> materialNames;  ///< "" = no material named
    std::vector<std::string> partNames;
    std::vector<std::string> materialLibraries;  ///< arguments of each mtllib line, in order, not yet split

    std::size_t faceCount() const { return faceStart.size() - 1; }
};

/// Something odd that was mended while reading: one entry per kind.
struct MeshWarning {
    std::string kind;  ///< "face refers to a vertex that does not exist; dropped"
    std::size_t count = 0;
    int firstLine = 0;  ///< 0: of the whole file
    std::string file;   ///< empty: the mesh's own
};

}  // namespace limn
