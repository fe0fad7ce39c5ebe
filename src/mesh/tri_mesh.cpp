#include "mesh/tri_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace limn {
namespace {

/// Which corners of the mesh make which triangles.
struct Triangles {
    std::vector<std::uint32_t> corner;  ///< three per triangle, indices into the PolyMesh's corners
    std::vector<std::uint32_t> face;    ///< of each triangle; empty when not asked for
};

bool isPlainQuad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    // Both triangles of the diagonal a–c face the same way: true for convex quads and for those that are concave at a
    // or c.
    return glm::dot(glm::cross(b - a, c - a), glm::cross(c - a, d - a)) > 0;
}

Triangles triangulate(const PolyMesh& mesh, bool wantFaces) {
    const std::size_t faces = mesh.faceCount();
    std::vector<char> special(faces);
    tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t f) {
        const std::size_t start = mesh.faceStart[f], size = mesh.faceStart[f + 1] - start;
        const auto position = [&](std::size_t i) -> const glm::dvec3& {
            return mesh.positions[mesh.cornerPosition[start + i]];
        };
        special[f] = size > 4 || (size == 4 && !isPlainQuad(position(0), position(1), position(2), position(3)));
    });
    std::unordered_map<std::size_t, std::vector<std::uint32_t>> filled;
    std::vector<std::uint32_t> offset(faces + 1, 0);
    for (std::size_t f = 0; f < faces; ++f) {
        const std::size_t start = mesh.faceStart[f], size = mesh.faceStart[f + 1] - start;
        std::size_t count = size - 2;
        if (special[f]) {
            std::vector<glm::dvec3> polygon;
            for (std::size_t i = 0; i < size; ++i) polygon.push_back(mesh.positions[mesh.cornerPosition[start + i]]);
            count = (filled[f] = triangulatePolygon(polygon)).size() / 3;
        }
        offset[f + 1] = offset[f] + static_cast<std::uint32_t>(count);
    }

    Triangles triangles;
    triangles.corner.resize(std::size_t{offset[faces]} * 3);
    if (wantFaces) triangles.face.resize(offset[faces]);
    tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t f) {
        const std::uint32_t start = mesh.faceStart[f];
        std::uint32_t* out = triangles.corner.data() + std::size_t{offset[f]} * 3;
        if (special[f]) {
            for (const auto corner : filled.at(f)) *out++ = start + corner;
        } else {
            for (std::uint32_t i = 1; i + 1 < mesh.faceStart[f + 1] - start; ++i)
                *out++ = start, *out++ = start + i, *out++ = start + i + 1;
        }
        if (wantFaces)
            std::fill(triangles.face.begin() + offset[f], triangles.face.begin() + offset[f + 1],
                static_cast<std::uint32_t>(f));
    });
    return triangles;
}

/// Area-weighted normal of a face of any size; zero for a degenerate face.
glm::dvec3 faceVector(const PolyMesh& mesh, std::size_t face) {
    const std::size_t start = mesh.faceStart[face], end = mesh.faceStart[face + 1];
    const auto& origin = mesh.positions[mesh.cornerPosition[start]];
    glm::dvec3 sum(0);
    for (std::size_t c = start + 1; c + 1 < end; ++c)
        sum += glm::cross(
            mesh.positions[mesh.cornerPosition[c]] - origin, mesh.positions[mesh.cornerPosition[c + 1]] - origin);
    return sum;
}

/// One normal per corner, made from the faces around its vertex.
std::vector<glm::vec3> makeCornerNormals(const PolyMesh& mesh) {
    const std::size_t faces = mesh.faceCount(), corners = mesh.cornerPosition.size();
    std::vector<glm::dvec3> vectors(faces);
    tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t f) { vectors[f] = faceVector(mesh, f); });

    std::vector<std::uint32_t> cornerFace(corners), first(mesh.positions.size() + 1, 0), around(corners);
    for (std::size_t f = 0; f < faces; ++f)
        for (std::uint32_t c = mesh.faceStart[f]; c < mesh.faceStart[f + 1]; ++c)
            cornerFace[c] = static_cast<std::uint32_t>(f), ++first[mesh.cornerPosition[c] + 1];
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) first[v + 1] += first[v];
    auto next = first;
    for (std::uint32_t c = 0; c < corners; ++c) around[next[mesh.cornerPosition[c]]++] = c;

    const double smoothCosine = std::cos(glm::radians(kSmoothAngleDegrees));
    std::vector<glm::vec3> normals(corners);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, mesh.positions.size()), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t v = range.begin(); v < range.end(); ++v) {
                for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
                    const std::uint32_t corner = around[i], face = cornerFace[corner];
                    const glm::dvec3 own = unitOrZero(vectors[face]);
                    glm::dvec3 sum(0);
                    // A vertex of thousands of faces (a cone's tip) would cost their square: there each face keeps its
                    // own normal.
                    const bool crowded = first[v + 1] - first[v] > 4096;
                    for (std::uint32_t j = first[v]; j < first[v + 1] && !crowded; ++j) {
                        const std::uint32_t other = cornerFace[around[j]];
                        const bool smooth = mesh.hasSmoothing
                            ? mesh.faceSmoothing[face] != 0 && mesh.faceSmoothing[face] == mesh.faceSmoothing[other]
                            : glm::dot(own, unitOrZero(vectors[other])) >= smoothCosine;
                        if (smooth || other == face) sum += vectors[other];
                    }
                    const glm::dvec3 unit = unitOrZero(crowded ? own : sum);
                    normals[corner] = glm::dot(unit, unit) > 0 ? unit : own;
                }
            }
        });
    return normals;
}

/// Gives each distinct (position, normal, uv) of a corner one vertex.
class VertexGatherer {
public:
    VertexGatherer(const PolyMesh& mesh, TriMesh& out, const MeshNeeds& needs)
        : mesh_(mesh), out_(out), needs_(needs), head_(mesh.positions.size(), kNone) {}

    std::vector<std::uint32_t> gather(const std::vector<glm::vec3>& made) {
        std::vector<std::uint32_t> cornerVertex(mesh_.cornerPosition.size());
        const bool fileNormals = needs_.normals && made.empty(), fileUvs = needs_.uvs && !mesh_.cornerUv.empty();
        next_.reserve(mesh_.positions.size());
        for (std::size_t c = 0; c < cornerVertex.size(); ++c) {
            glm::vec3 normal(0);
            if (fileNormals && mesh_.cornerNormal[c] != PolyMesh::kNone)
                normal = unitOrZero(mesh_.normals[static_cast<std::size_t>(mesh_.cornerNormal[c])]);
            else if (!made.empty())
                normal = made[c];
            const glm::vec2 uv = fileUvs && mesh_.cornerUv[c] != PolyMesh::kNone
                ? mesh_.uvs[static_cast<std::size_t>(mesh_.cornerUv[c])]
                : glm::vec2(0);
            cornerVertex[c] = vertex(mesh_.cornerPosition[c], normal, uv);
        }
        return cornerVertex;
    }

private:
    static constexpr std::uint32_t kNone = ~0u;

    std::uint32_t vertex(std::uint32_t position, const glm::vec3& normal, const glm::vec2& uv) {
        std::uint32_t v = head_[position];
        // A cone's tip may have a hundred thousand different normals: a longer search for an equal one costs more than
        // a vertex.
        for (int steps = 0; v != kNone && steps < 256; v = next_[v], ++steps)
            if ((!needs_.normals || out_.normals[v] == normal) && (!needs_.uvs || out_.uvs[v] == uv)) return v;
        v = static_cast<std::uint32_t>(out_.positions.size());
        out_.positions.emplace_back(mesh_.positions[position] - out_.pivot);
        if (needs_.normals) out_.normals.push_back(normal);
        if (needs_.uvs) out_.uvs.push_back(uv);
        if (needs_.colors && !mesh_.colors.empty()) out_.colors.push_back(mesh_.colors[position]);
        next_.push_back(head_[position]);
        head_[position] = v;
        return v;
    }

    const PolyMesh& mesh_;
    TriMesh& out_;
    MeshNeeds needs_;
    std::vector<std::uint32_t> head_, next_;
};

bool allZero(const std::vector<std::uint32_t>& values) {
    return std::all_of(values.begin(), values.end(), [](auto v) { return v == 0; });
}

}  // namespace

glm::dvec3 choosePivot(const PolyMesh& mesh) {
    Bounds bounds;
    for (const auto v : mesh.cornerPosition) bounds.add(mesh.positions[v]);
    if (bounds.empty())
        for (const auto& line : mesh.lines) bounds.add(line.a), bounds.add(line.b);
    const double size = bounds.diagonal();
    if (!(size > 0)) return bounds.centre();
    const double grid = std::ldexp(1.0, std::ilogb(size) - 8);
    // Not round(): it moves halves away from zero, so a moved copy could round another way.
    return glm::floor(bounds.centre() / grid + 0.5) * grid;
}

void numberByLastVertex(TriMesh& mesh) {
    constexpr std::uint32_t none = ~0u;
    const std::size_t count = mesh.triangleCount();
    std::vector<std::uint32_t> place(mesh.positions.size(), none);  // the first new vertex that holds each position
    std::vector<glm::vec3> positions(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        std::uint32_t* corner = mesh.indices.data() + std::size_t{3} * t;
        // A corner whose position no triangle has yet taken need not be repeated.
        std::size_t last = 2;
        for (std::size_t k = 0; k < 3; ++k)
            if (place[corner[k]] == none) last = k;
        const auto turn = [&](std::vector<std::uint32_t>& indices) {
            if (!indices.empty())
                std::rotate(indices.begin() + std::ptrdiff_t{3} * t,
                    indices.begin() + std::ptrdiff_t{3} * t + static_cast<std::ptrdiff_t>((last + 1) % 3),
                    indices.begin() + std::ptrdiff_t{3} * t + 3);
        };
        turn(mesh.indices);
        turn(mesh.normalIndices);
        turn(mesh.uvIndices);
        turn(mesh.colorIndices);
        positions[t] = mesh.positions[corner[2]];
        if (place[corner[2]] == none) place[corner[2]] = t;
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        for (std::size_t k = 0; k < 2; ++k) {
            std::uint32_t& index = mesh.indices[std::size_t{3} * t + k];
            const std::uint32_t old = index;
            if (place[old] == none) {
                place[old] = static_cast<std::uint32_t>(positions.size());
                positions.push_back(mesh.positions[old]);
            }
            index = place[old];
        }
        mesh.indices[std::size_t{3} * t + 2] = t;
    }
    mesh.positions = std::move(positions);
}

std::vector<Segment> segmentsOf(const PolyMesh& mesh, const glm::dvec3& pivot) {
    std::vector<Segment> segments;
    for (const auto& line : mesh.lines)
        segments.push_back({glm::vec3(line.a - pivot), glm::vec3(line.b - pivot), line.material, false});
    return segments;
}

TriMesh buildTriMesh(const PolyMesh& mesh, const MeshNeeds& needs) {
    TriMesh out = triangulateMesh(mesh, needs, choosePivot(mesh));
    if (!needs.unified) numberByLastVertex(out);
    return out;
}

TriMesh triangulateMesh(const PolyMesh& mesh, const MeshNeeds& needs, const glm::dvec3& pivot) {
    TriMesh out;
    out.pivot = pivot;
    out.segments = segmentsOf(mesh, pivot);
    const bool wantMaterials = !allZero(mesh.faceMaterial), wantParts = !allZero(mesh.facePart);
    const Triangles triangles = triangulate(mesh, wantMaterials || wantParts);

    std::vector<glm::vec3> made;
    if (needs.normals
        && (mesh.cornerNormal.empty()
            || std::find(mesh.cornerNormal.begin(), mesh.cornerNormal.end(), PolyMesh::kNone)
                != mesh.cornerNormal.end())) {
        made = makeCornerNormals(mesh);
        if (!mesh.cornerNormal.empty())
            for (std::size_t c = 0; c < made.size(); ++c)
                if (mesh.cornerNormal[c] != PolyMesh::kNone)
                    made[c] = unitOrZero(mesh.normals[static_cast<std::size_t>(mesh.cornerNormal[c])]);
    }
    const bool fileNormals = needs.normals && made.empty();
    std::vector<std::uint32_t> cornerVertex;
    if (needs.unified && (needs.normals || needs.uvs)) {
        cornerVertex = VertexGatherer(mesh, out, needs).gather(made);
    } else {
        out.positions.resize(mesh.positions.size());
        tbb::parallel_for(std::size_t{0}, mesh.positions.size(),
            [&](std::size_t i) { out.positions[i] = glm::vec3(mesh.positions[i] - out.pivot); });
        if (needs.colors) out.colors = mesh.colors;
        // Attributes keep the file's own indices, so that a vertex whose faces differ in normal is still one vertex to
        // the rasterizer.
        if (fileNormals) {
            out.normals.resize(mesh.normals.size());
            tbb::parallel_for(std::size_t{0}, mesh.normals.size(),
                [&](std::size_t i) { out.normals[i] = unitOrZero(mesh.normals[i]); });
        } else if (needs.normals) {
            out.normals = std::move(made);
        }
        if (needs.uvs) {
            out.uvs = mesh.uvs;
            out.uvs.emplace_back(0);  // for corners without
        }
    }
    const auto normalOf = [&](std::uint32_t corner) {
        return fileNormals ? static_cast<std::uint32_t>(mesh.cornerNormal[corner]) : corner;
    };
    const auto uvOf = [&](std::uint32_t corner) {
        return mesh.cornerUv.empty() || mesh.cornerUv[corner] == PolyMesh::kNone
            ? static_cast<std::uint32_t>(mesh.uvs.size())
            : static_cast<std::uint32_t>(mesh.cornerUv[corner]);
    };
    const bool ownNormals = needs.normals && !needs.unified, ownUvs = needs.uvs && !needs.unified,
               ownColors = !out.colors.empty() && !needs.unified;
    const auto vertexOf = [&](std::uint32_t corner) {
        return cornerVertex.empty() ? mesh.cornerPosition[corner] : cornerVertex[corner];
    };

    const std::size_t count = triangles.corner.size() / 3;
    std::vector<char> keep(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
        const auto& a = mesh.positions[mesh.cornerPosition[triangles.corner[3 * t]]];
        const auto area = glm::cross(mesh.positions[mesh.cornerPosition[triangles.corner[3 * t + 1]]] - a,
            mesh.positions[mesh.cornerPosition[triangles.corner[3 * t + 2]]] - a);
        keep[t] = area.x != 0 || area.y != 0 || area.z != 0;
    });
    std::size_t kept = 0;
    out.indices.resize(triangles.corner.size());
    if (ownNormals) out.normalIndices.resize(triangles.corner.size());
    if (ownUvs) out.uvIndices.resize(triangles.corner.size());
    if (ownColors) out.colorIndices.resize(triangles.corner.size());
    if (wantMaterials) out.triangleMaterial.resize(count);
    if (wantParts) out.trianglePart.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
        if (!keep[t]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = triangles.corner[3 * t + k];
            out.indices[3 * kept + k] = vertexOf(corner);
            if (ownNormals) out.normalIndices[3 * kept + k] = normalOf(corner);
            if (ownUvs) out.uvIndices[3 * kept + k] = uvOf(corner);
            if (ownColors) out.colorIndices[3 * kept + k] = mesh.cornerPosition[corner];
        }
        if (wantMaterials) out.triangleMaterial[kept] = mesh.faceMaterial[triangles.face[t]];
        if (wantParts) out.trianglePart[kept] = mesh.facePart[triangles.face[t]];
        ++kept;
    }
    out.indices.resize(3 * kept);
    if (ownNormals) out.normalIndices.resize(3 * kept);
    if (ownUvs) out.uvIndices.resize(3 * kept);
    if (ownColors) out.colorIndices.resize(3 * kept);
    if (wantMaterials) out.triangleMaterial.resize(kept);
    if (wantParts) out.trianglePart.resize(kept);
    return out;
}

}  // namespace limn
