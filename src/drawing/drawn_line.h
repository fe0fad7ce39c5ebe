// Lines from the mesh: their sources, and the polylines that are drawn.
#pragma once

#include "settings/fields.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace limn {

/// Why there is a line. Where several reasons hold for an edge, the first in kMeshLinePriority that is asked for
/// counts.
enum class MeshLineSource { contours, creases, borders, materials, objects, intersections, marks, sections };
inline constexpr std::size_t kMeshLineSources = 8;
template <>
inline constexpr std::array<std::string_view, kMeshLineSources> enumNames<MeshLineSource> = {
    "contours", "creases", "borders", "materials", "objects", "intersections", "marks", "sections"};

inline constexpr std::array kMeshLinePriority = {MeshLineSource::sections, MeshLineSource::contours,
    MeshLineSource::borders, MeshLineSource::objects, MeshLineSource::materials, MeshLineSource::creases,
    MeshLineSource::intersections, MeshLineSource::marks};

/// One value for each source.
template <class T>
using PerMeshSource = std::array<T, kMeshLineSources>;

struct LinePoint {
    glm::dvec2 place{0};  ///< in the whole picture, from its lower left; pixels
    double depth = 1;     ///< along the view axis; normalized units
};

/// A polyline in the picture. All of it has one look and lies behind the same number of faces.
struct DrawnLine {
    MeshLineSource source = MeshLineSource::contours;
    std::uint32_t record = 0;    ///< line record: index into SceneAt::lineRecords
    std::uint32_t instance = 0;  ///< index into SceneAt::instances
    std::uint32_t part = 0;      ///< of its mesh: index into DrawInstance::parts
    std::uint32_t material = 0;  ///< index into SceneAt::materials
    int behind = 0;              ///< faces before it; 0: it is visible
    bool isClosed = false;       ///< its last point joins its first
    std::vector<LinePoint> points;
};

/// What is to be found.
struct MeshLineRequest {
    PerMeshSource<bool> wanted{};
    double creaseCosine = 0.766;  ///< of the smallest angle between normals that makes a crease
    int deepest = 0;              ///< faces that a line may lie behind; 0: only visible ones are wanted
    double margin = 0;            ///< pixels around the picture in which lines matter
    bool operator==(const MeshLineRequest&) const = default;
};

}  // namespace limn
