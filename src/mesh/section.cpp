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
        for (const auto& segment : in_.segments) clip(segment);
        fill();
        return {std::move(out_), open_};
    }

private:
    /// A piece of outline: a cut triangle's.
    struct OutlineEdge {
        glm::vec3 from, to;
        std::uint32_t material, part;  ///< material: of the mesh, also where a cut face was cut
        std::uint32_t fromPoint = 0, toPoint = 0;
    };

    void clip(Segment segment) {
        const double a = plane_.height(segment.a), b = plane_.height(segment.b);
        if (a > 0 && b > 0) return;
        const auto between = [&] { return segment.a + (segment.b - segment.a) * static_cast<float>(a / (a - b)); };
        if (a > 0)
            segment.a = between();
        else if (b > 0)
            segment.b = between();
        out_.segments.push_back(segment);
    }

    std::uint32_t meshMaterial(std::uint32_t material) const { return material % std::max(plane_.materialCount, 1u); }

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
        if (from != to) outline_.push_back({from, to, meshMaterial(material), part});
    }

    bool isThin(const Corner& a, const Corner& b, const Corner& c) const {
        const auto& p = out_.positions;
        return p[a.position] == p[b.position] || p[b.position] == p[c.position] || p[c.position] == p[a.position];
    }

    using Outlines = std::vector<std::vector<std::uint32_t>>;

    /// Numbers the ends of the outline's edges: equal places are one point.
    void numberPoints() {
        std::unordered_map<glm::vec3, std::uint32_t, PointHash> number;
        const auto numberOf = [&](const glm::vec3& p) {
            const auto [it, isNew] = number.emplace(p, static_cast<std::uint32_t>(points_.size()));
            if (isNew) points_.emplace_back(p);
            return it->second;
        };
        for (auto& edge : outline_) edge.fromPoint = numberOf(edge.from), edge.toPoint = numberOf(edge.to);
    }

    /// The material of most of a line's length.
    std::uint32_t materialOf(const std::vector<std::size_t>& line) const {
        std::map<std::uint32_t, double> lengths;
        for (const auto e : line)
            lengths[outline_[e].material] += static_cast<double>(glm::distance(outline_[e].from, outline_[e].to));
        return std::max_element(lengths.begin(), lengths.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
        })->first;
    }

    /// Walks from point to point. Where several edges leave a point, the one of the same part and material goes on, or
    /// else any: winding decides what is inside. Closed outlines are sorted by material, open ones become segments.
    std::map<std::uint32_t, Outlines> walkOutlines() {
        std::multimap<std::uint32_t, std::size_t> onward;
        for (std::size_t e = 0; e < outline_.size(); ++e) onward.emplace(outline_[e].fromPoint, e);
        const auto nextAfter = [&](std::size_t e) {
            const auto [first, last] = onward.equal_range(outline_[e].toPoint);
            const auto alike = std::find_if(first, last, [&](const auto& other) {
                return outline_[other.second].material == outline_[e].material
                    && outline_[other.second].part == outline_[e].part;
            });
            return alike != last ? alike : first != last ? first : onward.end();
        };
        // Open lines begin at points that more edges leave than reach: walk those first.
        std::vector<int> surplus(points_.size());
        for (const auto& edge : outline_) ++surplus[edge.fromPoint], --surplus[edge.toPoint];
        std::vector<std::uint32_t> starts;
        for (std::uint32_t i = 0; i < surplus.size(); ++i)
            starts.insert(starts.end(), static_cast<std::size_t>(std::max(surplus[i], 0)), i);
        std::map<std::uint32_t, Outlines> closed;
        while (!onward.empty()) {
            auto next = onward.begin();
            if (!starts.empty()) {
                next = onward.find(starts.back());
                starts.pop_back();
            }
            if (next == onward.end()) continue;
            std::vector<std::size_t> line;
            do {
                line.push_back(next->second);
                onward.erase(next);
                next = nextAfter(line.back());
            } while (next != onward.end() && outline_[line.back()].toPoint != outline_[line.front()].fromPoint);
            finishLine(line, closed);
        }
        return closed;
    }

    void finishLine(const std::vector<std::size_t>& line, std::map<std::uint32_t, Outlines>& closed) {
        const std::uint32_t material = materialOf(line);
        if (outline_[line.back()].toPoint == outline_[line.front()].fromPoint) {
            if (line.size() < 3) return;
            auto& outline = closed[material].emplace_back();
            for (const auto e : line) outline.push_back(outline_[e].fromPoint);
            return;
        }
        ++open_;
        for (const auto e : line)
            out_.segments.push_back({outline_[e].from, outline_[e].to, plane_.material + material, true});
    }

    void fill() {
        numberPoints();
        for (const auto& [material, outlines] : walkOutlines()) fill(plane_.material + material, outlines);
    }

    void fill(std::uint32_t material, const Outlines& outlines) {
        std::vector<glm::dvec3> points = points_;
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
            add(corners, material, plane_.part);
        }
    }

    const TriMesh& in_;
    const CutPlane& plane_;
    const MeshNeeds& needs_;
    TriMesh out_;
    std::vector<OutlineEdge> outline_;
    std::vector<glm::dvec3> points_;  ///< of the outline
    std::size_t open_ = 0;
};

}  // namespace

bool isCut(const TriMesh& mesh, const CutPlane& plane) {
    return std::any_of(
               mesh.positions.begin(), mesh.positions.end(), [&](const glm::vec3& p) { return plane.height(p) > 0; })
        || std::any_of(mesh.segments.begin(), mesh.segments.end(),
            [&](const Segment& s) { return plane.height(s.a) > 0 || plane.height(s.b) > 0; });
}

CutMesh cutMesh(const TriMesh& mesh, const CutPlane& plane, const MeshNeeds& needs) {
    return Cutter(mesh, plane, needs).cut();
}

}  // namespace limn
