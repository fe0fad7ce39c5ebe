#include "render/edge_rates.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace limn {
namespace {

/// One instance as one frame's camera sees it.
struct Viewer {
    glm::dmat4 viewFromMesh;        ///< to normalized view space
    double worldScale;              ///< longest stretch of the instance
    bool orthographic;
    double pixelsPerUnit;           ///< at unit depth; orthographic: anywhere
    glm::dvec2 low, high;           ///< of the picture, at unit depth

    /// Pixels that an edge spans however it is turned, or 0 where it cannot be seen.
    double pixels(const glm::dvec3& a, const glm::dvec3& b) const {
        const glm::dvec3 p(viewFromMesh * glm::dvec4(a, 1)), q(viewFromMesh * glm::dvec4(b, 1));
        const double length = glm::distance(p, q);
        // The faces on the edge reach about as far as the edge is long: only if all of that is out of sight may it stay coarse.
        const double room = 2 * length;
        const glm::dvec3 middle = (p + q) * 0.5;
        if (orthographic) {
            const bool outside = middle.x < low.x - room || middle.x > high.x + room || middle.y < low.y - room || middle.y > high.y + room;
            return outside ? 0 : length * pixelsPerUnit;
        }
        const double depth = -middle.z, reach = depth + room;
        if (reach <= 0) return 0;
        if (middle.x < low.x * reach - room || middle.x > high.x * reach + room || middle.y < low.y * reach - room || middle.y > high.y * reach + room) return 0;
        // What is in the picture at that distance is no nearer along the axis than this, whatever lies beside the camera or behind it.
        const double corner = 1 / std::sqrt(1 + std::max(glm::dot(low, low), glm::dot(high, high)));
        const double nearest = std::max({std::min(-p.z, -q.z), (glm::length(middle) - length / 2) * corner, 0.05 * length});
        return length * pixelsPerUnit / nearest;
    }
    bool operator==(const Viewer&) const = default;
};

}  // namespace

std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRates(const LoadedScene& loaded, std::size_t number, const RenderConfig& config) {
    const auto wanted = loaded.scene.meshes[meshIndex(loaded.scene, loaded.scene.instances[number].base.mesh)].subdivision.wantedEdge();
    if (!wanted) return {};
    auto viewers = std::make_shared<std::vector<Viewer>>();
    const FrameRange frames = loaded.scene.frames.value_or(FrameRange{loaded.scene.firstFrame(), loaded.scene.firstFrame()});
    for (int frame = frames.first; frame <= frames.last; ++frame) {
        const DrawScene scene = resolveFrame(loaded, frameRequest(config, frame));
        const View view = makeView(scene.camera, scene.info, {.imageSize = config.image.size});
        const glm::dvec2 size(config.image.size);
        const auto& instance = scene.instances[number];
        glm::dmat4 toView(view.viewFromRelative * glm::dmat3(instance.worldFromMesh));
        toView[3] = glm::dvec4(view.toView(glm::dvec3(instance.worldFromMesh[3])), 1);
        const glm::dmat3 linear(instance.worldFromMesh);
        const Viewer viewer{toView, std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])}), view.orthographic, 1 / view.rayScale.x, view.rayOffset, size * view.rayScale + view.rayOffset};
        if (std::find(viewers->begin(), viewers->end(), viewer) == viewers->end()) viewers->push_back(viewer);
    }
    return [viewers, wanted = *wanted](const glm::dvec3& a, const glm::dvec3& b) {
        double segments = 1;
        for (const auto& viewer : *viewers) segments = std::max(segments, (wanted.isPixels ? viewer.pixels(a, b) : glm::distance(a, b) * viewer.worldScale) / wanted.amount);
        return static_cast<int>(std::lround(std::min(segments, 1e6)));
    };
}

}  // namespace limn
