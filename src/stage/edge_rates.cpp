#include "stage/edge_rates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace limn {
namespace {

/// One instance as one frame's camera sees it.
struct Viewer {
    glm::dmat4 viewFromMesh;  ///< to normalized view space
    double worldScale;        ///< longest stretch of the instance
    bool orthographic;
    double pixelsPerUnit;  ///< at unit depth; orthographic: anywhere
    glm::dvec2 low, high;  ///< of the picture, at unit depth

    /// Pixels that an edge spans, whatever its direction, or 0 where it is not visible.
    double pixels(const glm::dvec3& a, const glm::dvec3& b) const {
        const glm::dvec3 p(viewFromMesh * glm::dvec4(a, 1)), q(viewFromMesh * glm::dvec4(b, 1));
        const double length = glm::distance(p, q);
        // The faces on the edge reach about as far as the edge is long. It may stay coarse only if all of that is out
        // of sight.
        const double room = 2 * length;
        const glm::dvec3 middle = (p + q) * 0.5;
        if (orthographic) {
            const bool outside = middle.x < low.x - room || middle.x > high.x + room || middle.y < low.y - room
                || middle.y > high.y + room;
            return outside ? 0 : length * pixelsPerUnit;
        }
        const double depth = -middle.z, reach = depth + room;
        if (reach <= 0) return 0;
        if (middle.x < low.x * reach - room || middle.x > high.x * reach + room || middle.y < low.y * reach - room
            || middle.y > high.y * reach + room)
            return 0;
        // Nothing in the picture at that distance is nearer along the axis than this, whatever lies beside or behind
        // the camera.
        const double corner = 1 / std::sqrt(1 + std::max(glm::dot(low, low), glm::dot(high, high)));
        const double nearest =
            std::max({std::min(-p.z, -q.z), (glm::length(middle) - length / 2) * corner, 0.05 * length});
        return length * pixelsPerUnit / nearest;
    }
    /// The most pixels that one unit of a mesh within a sphere can span.
    double pixelsPerUnitOf(const glm::dvec3& centre, double radius) const {
        const double stretch =
            std::max({glm::length(viewFromMesh[0]), glm::length(viewFromMesh[1]), glm::length(viewFromMesh[2])});
        const double distance = glm::length(glm::dvec3(viewFromMesh * glm::dvec4(centre, 1))) - radius * stretch;
        return stretch * pixelsPerUnit / (orthographic ? 1 : std::max(distance, 0.05 * radius * stretch));
    }
    bool operator==(const Viewer&) const = default;
};

/// The viewers of an instance, from the cameras of all declared frames, without repetitions.
std::vector<Viewer> findViewers(const LoadedScene& loaded, std::size_t number, const FrameRequest& request) {
    std::vector<Viewer> viewers;
    const FrameRange frames =
        loaded.scene.frames.value_or(FrameRange{loaded.scene.firstFrame(), loaded.scene.firstFrame()});
    const SceneInfo info = sceneInfo(loaded);
    const glm::dvec2 size(request.imageSize);
    for (int frame = frames.first; frame <= frames.last; ++frame) {
        FrameRequest at = request;
        at.frame = frame;
        const View view = makeView(cameraAt(loaded, at), info, {.imageSize = request.imageSize});
        const glm::dmat4 world = loaded.scene.worldFrom(loaded.scene.instances[number].at(frame), frame);
        const glm::dmat3 linear(world);
        glm::dmat4 toView(view.viewFromRelative * linear);
        toView[3] = glm::dvec4(view.toView(glm::dvec3(world[3])), 1);
        const double stretch = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
        const Viewer viewer{toView, stretch, view.orthographic, 1 / view.rayScale.x, view.rayOffset,
            size * view.rayScale + view.rayOffset};
        // Only neighbouring frames are compared: that finds everything that stands still.
        if (viewers.empty() || viewers.back() != viewer) viewers.push_back(viewer);
    }
    return viewers;
}

}  // namespace

/// Found out once for each instance, camera and size of picture.
struct EdgeViewers {
    using Asked = std::tuple<std::size_t, std::string, int, int, double, double>;
    std::mutex mutex;
    std::map<Asked, std::vector<Viewer>> known;

    const std::vector<Viewer>& of(const LoadedScene& loaded, std::size_t instance, const FrameRequest& request) {
        const std::lock_guard lock(mutex);
        const Asked asked{
            instance, request.camera, request.imageSize.x, request.imageSize.y, request.dpi, request.scale};
        const auto found = known.find(asked);
        return found != known.end() ? found->second
                                    : known.emplace(asked, findViewers(loaded, instance, request)).first->second;
    }
};

std::shared_ptr<EdgeViewers> makeEdgeViewers() { return std::make_shared<EdgeViewers>(); }

namespace {

/// The viewers of several instances.
std::vector<Viewer> viewersOf(
    const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request) {
    std::vector<Viewer> all;
    for (const std::size_t instance : instances)
        for (const Viewer& viewer : loaded.viewers->of(loaded, instance, request))
            if (all.empty() || all.back() != viewer) all.push_back(viewer);
    return all;
}

std::optional<SubdivisionSettings::EdgeLength> wantedEdge(const LoadedScene& loaded, std::size_t instance) {
    const std::size_t mesh = meshIndex(loaded.scene, loaded.scene.instances[instance].base.mesh);
    return loaded.scene.meshes[mesh].subdivision.wantedEdge();
}

}  // namespace

int edgeClass(const LoadedScene& loaded, const SceneAt& scene, std::size_t instance, const FrameRequest& request) {
    const std::size_t source = scene.instances[instance].source;
    const auto wanted = wantedEdge(loaded, source);
    if (!wanted) return 0;
    const Bounds& bounds = scene.meshes[static_cast<std::size_t>(scene.instances[instance].mesh)]->bounds;
    if (bounds.empty()) return 0;
    double size = 0;
    for (const auto& viewer : viewersOf(loaded, {&source, 1}, request))
        size = std::max(size,
            wanted->isPixels ? viewer.pixelsPerUnitOf(bounds.centre(), bounds.diagonal() / 2) : viewer.worldScale);
    constexpr int kClassesPerOctave = 2;
    return static_cast<int>(std::floor(kClassesPerOctave * std::log2(std::clamp(size, 1e-300, 1e300))));
}

std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRates(
    const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request) {
    const auto wanted = wantedEdge(loaded, instances.front());
    if (!wanted) return {};
    auto viewers = std::make_shared<std::vector<Viewer>>(viewersOf(loaded, instances, request));
    return [viewers, wanted = *wanted](const glm::dvec3& a, const glm::dvec3& b) {
        double segments = 1;
        for (const auto& viewer : *viewers) {
            const double length = wanted.isPixels ? viewer.pixels(a, b) : glm::distance(a, b) * viewer.worldScale;
            segments = std::max(segments, length / wanted.amount);
        }
        return static_cast<int>(std::lround(std::min(segments, 1e6)));
    };
}

void addEdgeRates(
    KeyBuilder& key, const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request) {
    const auto wanted = wantedEdge(loaded, instances.front());
    if (!wanted) return;
    key.add(wanted->amount).add(wanted->isPixels);
    for (const auto& viewer : viewersOf(loaded, instances, request)) {
        key.bytes(&viewer.viewFromMesh, sizeof viewer.viewFromMesh).add(viewer.worldScale).add(viewer.orthographic);
        key.add(viewer.pixelsPerUnit).bytes(&viewer.low, sizeof viewer.low).bytes(&viewer.high, sizeof viewer.high);
    }
}

}  // namespace limn
