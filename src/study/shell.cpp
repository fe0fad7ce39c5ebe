#include "study/shell.h"

#include <array>
#include <cmath>

namespace limn {

std::unique_ptr<RayScene> buildShell(
    const View& view, const SceneInfo& scene, std::span<const float> depth, std::span<const float> normals) {
    constexpr double kOffPlane = 1;  // pixel footprints: the sides of a corner are nearer, outlines farther
    const glm::ivec2 size = view.region.size;
    TriMesh mesh;
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double z = static_cast<double>(depth[index(x, y)]) * view.unit;
            const glm::dvec2 ray =
                (glm::dvec2(view.region.origin + glm::ivec2(x, size.y - 1 - y)) + 0.5) * view.rayScale + view.rayOffset;
            mesh.positions.emplace_back(
                std::isfinite(z) ? glm::dvec3(view.orthographic ? ray : ray * z, -z) : glm::dvec3(0));
        }
    const auto joined = [&](std::size_t a, std::size_t b) {
        if (!std::isfinite(depth[a]) || !std::isfinite(depth[b])) return false;
        const glm::dvec3 pa(mesh.positions[a]), pb(mesh.positions[b]);
        const auto normal = [&](std::size_t i) {
            return glm::dvec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
        };
        const double footprint = view.rayScale.x * (view.orthographic ? 1 : std::min(-pa.z, -pb.z));
        return std::min(std::abs(glm::dot(pb - pa, normal(a))), std::abs(glm::dot(pb - pa, normal(b))))
            <= kOffPlane * footprint;
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
