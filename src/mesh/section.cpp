#include "mesh/section.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

namespace limn {
namespace {

/// A corner of a triangle: its place in each of the mesh's lists.
struct Corner {
    std::uint32_t position, normal, uv, color;
};

bool before(const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

struct PointHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::size_t hash = 0;
        for (int i = 0; i < 3; ++i) hash = (hash ^ std::hash<float>()(p[i])) * 0x9e3779b97f4a7c15u;
        return hash;
    }
};

class Cutter {
public:
    Cutter(const TriMesh& in, const CutPlane& plane, const MeshNeeds& needs) : in_(in), plane_(plane), needs_(needs) {
        out_.pivot = in.pivot;
        out_.positions = in.positions;
        out_.normals = in.normals;
        out_.uvs = in.uvs;
        out_.colors = in.colors;
    }

    CutMesh cut() {
        std::vector<double> height(in_.positions.size());
        for (std::size_t i = 0; i < height.size(); ++i) height[i] = plane_.height(in_.positions[i]);
        for (std::size_t t = 0; t < in_.triangleCount(); ++t) {
            std::array<Corner, 3> corners;
            std::array<double, 3> h;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t i = 3 * t + k;
                corners[k] = {in_.indices[i], in_.normalIndices.empty() ? 0 : in_.normalIndices[i],
                    in_.uvIndices.empty() ? 0 : in_.uvIndices[i], in_.colorIndices.empty() ? 0 : in_.colorIndices[i]};
                h[k] = height[corners[k].position];
            }
            const std::uint32_t material = in_.triangleMaterial.empty() ? 0 : in_.triangleMaterial[t],
                                part = in_.trianglePart.empty() ? 0 : in_.trianglePart[t];
            const int above =
                static_cast<int>(std::count_if(h.begin(), h.end(), [](double value) { return value > 0; }));
            if (above == 0)
                add(corners, material, part);
            else if (above < 3)
                split(corners, h, material, part);
        }
        fill();
        return {std::move(out_), open_};
    }

private:
    void add(const std::array<Corner, 3>& corners, std::uint32_t material, std::uint32_t part) {
        for (const auto& corner : corners) {
            out_.indices.push_back(corner.position);
            if (!in_.normalIndices.empty()) out_.normalIndices.push_back(corner.normal);
            if (!in_.uvIndices.empty()) out_.uvIndices.push_back(corner.uv);
            if (!in_.colorIndices.empty()) out_.colorIndices.push_back(corner.color);
        }
        out_.triangleMaterial.push_back(material);
        out_.trianglePart.push_back(part);
    }

    /// The point where the edge from a to b meets the plane. Always computed from the same end, whichever face asks.
    Corner between(Corner a, double heightA, Corner b, double heightB) {
        if (before(in_.positions[b.position], in_.positions[a.position])) std::swap(a, b), std::swap(heightA, heightB);
        const double t = heightA / (heightA - heightB);
        const auto mix = [&](const auto& from, const auto& to) { return from + (to - from) * static_cast<float>(t); };
        const glm::dvec3 from(in_.positions[a.position]), to(in_.positions[b.position]);
        Corner made{static_cast<std::uint32_t>(out_.positions.size()), 0, 0, 0};
        out_.positions.emplace_back(from + (to - from) * t);
        const auto attribute = [&](auto& list, std::uint32_t place, std::uint32_t one, std::uint32_t other, bool own) {
            if (list.empty()) return place;
            const auto value = mix(list[own ? one : a.position], list[own ? other : b.position]);
            list.push_back(value);
            return static_cast<std::uint32_t>(list.size() - 1);
        };
        made.normal = attribute(out_.normals, 0, a.normal, b.normal, !in_.normalIndices.empty());
        made.uv = attribute(out_.uvs, 0, a.uv, b.uv, !in_.uvIndices.empty());
        made.color = attribute(out_.colors, 0, a.color, b.color, !in_.colorIndices.empty());
        return made;
    }

    void split(const std::array<Corner, 3>& corners, const std::array<double, 3>& h, std::uint32_t material,
        std::uint32_t part) {
        std::vector<Corner> kept;
        std::array<Corner, 2> ends{};  // where the outline enters and leaves the kept part
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if (h[k] <= 0) kept.push_back(corners[k]);
            if ((h[k] <= 0) == (h[next] <= 0)) continue;
            kept.push_back(between(corners[k], h[k], corners[next], h[next]));
            ends[h[k] <= 0 ? 0 : 1] = kept.back();
        }
        for (std::size_t k = 1; k + 1 < kept.size(); ++k)
            if (!isThin(kept[0], kept[k], kept[k + 1])) add({kept[0], kept[k], kept[k + 1]}, material, part);
        const glm::vec3 from = out_.positions[ends[0].position], to = out_.positions[ends[1].position];
        if (from != to) outline_.emplace_back(from, to);
    }

    bool isThin(const Corner& a, const Corner& b, const Corner& c) const {
        const auto& p = out_.positions;
        return p[a.position] == p[b.position] || p[b.position] == p[c.position] || p[c.position] == p[a.position];
    }

    void fill() {
        // Walks outlines from point to point. Where several lines leave a point, any of them will do: winding decides
        // what is inside.
        std::vector<glm::dvec3> points;
        std::unordered_map<glm::vec3, std::uint32_t, PointHash> number;
        const auto numberOf = [&](const glm::vec3& p) {
            const auto [it, isNew] = number.emplace(p, static_cast<std::uint32_t>(points.size()));
            if (isNew) points.emplace_back(p);
            return it->second;
        };
        std::multimap<std::uint32_t, std::uint32_t> onward;
        for (const auto& [from, to] : outline_) onward.emplace(numberOf(from), numberOf(to));
        // Open lines begin at points that more edges leave than reach: walk those first.
        std::vector<int> surplus(points.size());
        for (const auto& [from, to] : onward) {
            ++surplus[from];
            --surplus[to];
        }
        std::vector<std::uint32_t> starts;
        for (std::uint32_t i = 0; i < surplus.size(); ++i)
            starts.insert(starts.end(), static_cast<std::size_t>(std::max(surplus[i], 0)), i);
        std::vector<std::vector<std::uint32_t>> outlines;
        while (!onward.empty()) {
            auto next = onward.begin();
            if (!starts.empty()) {
                next = onward.find(starts.back());
                starts.pop_back();
            }
            if (next == onward.end()) continue;
            std::vector<std::uint32_t> line{next->first};
            for (; next != onward.end() && (line.size() == 1 || line.back() != line.front());
                 next = onward.find(line.back())) {
                line.push_back(next->second);
                onward.erase(next);
            }
            if (line.back() != line.front())
                ++open_;
            else if (line.pop_back(); line.size() >= 3)
                outlines.push_back(std::move(line));
        }
        const glm::dvec3 normal = glm::normalize(plane_.gradient);
        const auto triangles = triangulateOutlines(points, outlines, normal);
        if (triangles.empty()) return;
        const auto firstPoint = static_cast<std::uint32_t>(out_.positions.size());
        out_.positions.insert(out_.positions.end(), points.begin(), points.end());
        // An attribute with its own indices gets one value for all cut faces; else one beside each position.
        const auto firstNormal = static_cast<std::uint32_t>(out_.normals.size()),
                   firstUv = static_cast<std::uint32_t>(out_.uvs.size());
        if (needs_.normals)
            out_.normals.insert(out_.normals.end(), needs_.unified ? points.size() : 1, glm::vec3(normal));
        if (needs_.uvs) out_.uvs.insert(out_.uvs.end(), needs_.unified ? points.size() : 1, glm::vec2(0));
        const auto firstColor = static_cast<std::uint32_t>(out_.colors.size());
        if (!out_.colors.empty())
            out_.colors.insert(out_.colors.end(), needs_.unified ? points.size() : 1, glm::vec3(1));
        for (std::size_t i = 0; i < triangles.size(); i += 3) {
            std::array<Corner, 3> corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = {firstPoint + triangles[i + k], firstNormal, firstUv, firstColor};
            add(corners, plane_.material, plane_.part);
        }
    }

    const TriMesh& in_;
    const CutPlane& plane_;
    const MeshNeeds& needs_;
    TriMesh out_;
    std::vector<std::pair<glm::vec3, glm::vec3>> outline_;
    std::size_t open_ = 0;
};

}  // namespace

bool isCut(const TriMesh& mesh, const CutPlane& plane) {
    return std::any_of(
        mesh.positions.begin(), mesh.positions.end(), [&](const glm::vec3& p) { return plane.height(p) > 0; });
}

CutMesh cutMesh(const TriMesh& mesh, const CutPlane& plane, const MeshNeeds& needs) {
    return Cutter(mesh, plane, needs).cut();
}

}  // namespace limn
