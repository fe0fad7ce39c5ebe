#include "study/shell.h"

#include <array>
#include <cmath>

namespace limn {

glm::dvec3 placeOf(const View& view, int x, int y, double z) {
    const glm::ivec2 pixel = view.region.origin + glm::ivec2(x, view.region.size.y - 1 - y);
    const glm::dvec2 ray = (glm::dvec2(pixel) + 0.5) * view.rayScale + view.rayOffset;
    return {view.orthographic ? ray : ray * z, -z};
}

bool areJoined(const View& view, const glm::dvec3& a, const glm::dvec3& b, const float* normalA, const float* normalB) {
    constexpr double kOffPlane = 1;  // pixel footprints: the sides of a corner are nearer, outlines farther
    const auto off = [&](const float* n) { return std::abs(glm::dot(b - a, glm::dvec3(n[0], n[1], n[2]))); };
    const double footprint = view.rayScale.x * (view.orthographic ? 1 : std::min(-a.z, -b.z));
    return std::min(off(normalA), off(normalB)) <= kOffPlane * footprint;
}

std::unique_ptr<RayScene> buildShell(
    const View& view, const SceneInfo& scene, std::span<const float> depth, std::span<const float> normals) {
    const glm::ivec2 size = view.region.size;
    TriMesh mesh;
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double z = static_cast<double>(depth[index(x, y)]) * view.unit;
            mesh.positions.emplace_back(std::isfinite(z) ? placeOf(view, x, y, z) : glm::dvec3(0));
        }
    const auto joined = [&](std::size_t a, std::size_t b) {
        return std::isfinite(depth[a]) && std::isfinite(depth[b])
            && areJoined(
                view, glm::dvec3(mesh.positions[a]), glm::dvec3(mesh.positions[b]), &normals[3 * a], &normals[3 * b]);
    };
    for (int y = 0; y + 1 < size.y; ++y)
        for (int x = 0; x + 1 < size.x; ++x) {
            const std::size_t a = index(x, y), b = index(x + 1, y), c = index(x + 1, y + 1), d = index(x, y + 1);
            for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}})
                if (joined(t[0], t[1]) && joined(t[1], t[2]) && joined(t[2], t[0]))
                    for (const auto i : t) mesh.indices.push_back(static_cast<std::uint32_t>(i));
        }
    SceneAt shell;
    shell.info = scene;
    shell.instances.push_back({0, view.worldFromView(), {}, 1});
    const TriMesh* meshOf[] = {&mesh};
    return std::make_unique<RayScene>(shell, meshOf);
}

}  // namespace limn
