#include "gpu/lights.h"

#include "stage/shadow_layout.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace limn {
namespace {

// std140, as in shaders/scene/lights.glsl.
struct GpuLight {
    glm::vec4 direction, position, color, cone, shadow;
    glm::vec4 shadowPlace[6];
    glm::mat4 shadowFromView[6];
};
static_assert(sizeof(GpuLight) == 560);

/// Reversed-depth perspective over `fov` (full angle, radians), square.
glm::dmat4 lightPerspective(double fov, double near) {
    const double f = 1 / std::tan(fov / 2);
    glm::dmat4 m(0);
    m[0][0] = m[1][1] = f;
    m[2][3] = -1;
    m[3][2] = near;
    return m;
}

/// A view along `forward` from the origin, with an arbitrary up.
glm::dmat4 lookAlong(const glm::dvec3& forward) {
    const glm::dvec3 up = std::abs(forward.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return glm::lookAt(glm::dvec3(0), forward, up);
}

constexpr glm::dvec3 kCubeFaces[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

ShadowProjection projectionOf(const Light& light, int face, const SceneInfo& scene) {
    if (light.kind == LightKind::sun) {
        // A sphere around the scene keeps the map's texels still while the camera moves.
        const double radius = scene.diagonal() / 2;
        glm::dmat4 clip(1);
        clip[0][0] = clip[1][1] = 1 / radius;
        // Depths -radius … radius → 1 … 0.
        clip[2][2] = 1 / (2 * radius);
        clip[3][2] = 0.5;
        return {scene.bounds.centre(), clip * lookAlong(glm::normalize(light.direction))};
    }
    const double near = scene.diagonal() * 1e-4;
    if (light.kind == LightKind::spot)
        return {light.position,
            lightPerspective(glm::radians(light.angle), near) * lookAlong(glm::normalize(light.direction))};
    return {light.position, lightPerspective(glm::radians(90.0), near) * lookAlong(kCubeFaces[face])};
}

}  // namespace

std::size_t lightSize() { return sizeof(GpuLight); }

std::vector<ShadowProjection> shadowProjections(const SceneAt& scene) {
    std::vector<ShadowProjection> projections;
    for (const auto& map : shadowLayout(scene.lights).maps)
        projections.push_back(
            projectionOf(scene.lights[static_cast<std::size_t>(map.number / 8)], map.number % 8, scene.info));
    return projections;
}

std::vector<std::byte> lightBytes(const SceneAt& scene, const View& view) {
    std::vector<GpuLight> lights;
    const ShadowLayout layout = shadowLayout(scene.lights);
    // World directions and lengths, counted from the eye.
    const glm::dmat4 relativeFromView(glm::transpose(view.viewFromRelative) / (view.unit * view.unit));
    for (const auto& light : scene.lights) {
        GpuLight gpu{};
        const glm::dvec3 towards =
            light.kind == LightKind::point ? glm::dvec3(0) : -glm::normalize(view.viewFromRelative * light.direction);
        gpu.direction = glm::vec4(glm::vec3(towards), static_cast<float>(light.kind));
        gpu.position = glm::vec4(glm::vec3(view.toView(light.position)),
            light.range > 0 ? static_cast<float>(1 / (light.range * view.unit)) : 0.0f);
        gpu.color = glm::vec4(light.color.r, light.color.g, light.color.b, 0) * static_cast<float>(light.intensity);
        const double half = glm::radians(light.angle) / 2;
        // A hard edge is a very narrow one, since smoothstep needs two different ends.
        gpu.cone = {std::cos(half), std::max(std::cos(half * (1 - light.blend)), std::cos(half) + 1e-6), 0, 0};
        if (light.shadow.present) {
            const double texelAtUnit = light.kind == LightKind::sun
                ? scene.info.diagonal() * view.unit / light.shadow.resolution
                : light.kind == LightKind::spot ? 2 * std::tan(half) / light.shadow.resolution
                                                : 2.0 / light.shadow.resolution;
            gpu.shadow = {texelAtUnit, light.shadow.softness, 0, 1};
            for (const auto& map : layout.maps) {
                if (map.number / 8 != static_cast<int>(lights.size())) continue;
                const ShadowProjection projection = projectionOf(light, map.number % 8, scene.info);
                gpu.shadowPlace[map.number % 8] = glm::vec4(map.viewport);
                gpu.shadowFromView[map.number % 8] = projection.clipFromRelative
                    * glm::translate(glm::dmat4(1), view.eye - projection.origin) * relativeFromView;
            }
        }
        lights.push_back(gpu);
    }
    const auto bytes = std::as_bytes(std::span(lights));
    return {bytes.begin(), bytes.end()};
}

}  // namespace limn
