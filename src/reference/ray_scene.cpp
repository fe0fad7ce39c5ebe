#include "reference/ray_scene.h"

#include "base/error.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>
#include <vector>

namespace limn {
namespace {

struct ReleaseDevice { void operator()(RTCDevice device) const { rtcReleaseDevice(device); } };
struct ReleaseScene { void operator()(RTCScene scene) const { rtcReleaseScene(scene); } };
using TreeDevice = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Tree = std::unique_ptr<RTCSceneTy, ReleaseScene>;

/// Embree reports by code; the only failure that input can cause is a lack of memory.
void check(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw Error(ExitCode::outOfMemory, {}, "there is not enough memory for the ray tracing tree", "use coarser meshes, or a screen-space technique");
    throw Error(ExitCode::internal, {}, "Embree failed with code " + std::to_string(static_cast<int>(error)), "please report this");
}

Tree makeScene(RTCDevice device) {
    Tree scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

void addTriangles(RTCDevice device, RTCScene scene, const TriMesh& mesh, const glm::dmat3& linear, const glm::dvec3& offset) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangleCount()));
    if (vertices && indices) {
        tbb::parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t i) {
            const glm::vec3 p(linear * glm::dvec3(mesh.positions[i]) + offset);
            for (int k = 0; k < 3; ++k) vertices[3 * i + static_cast<std::size_t>(k)] = p[k];
        });
        std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    check(device);
}

}  // namespace

struct RayScene::Trees {
    TreeDevice device;
    std::vector<Tree> shared;
    Tree top;
};

RayScene::RayScene(const DrawScene& scene, std::span<const TriMesh> meshes, std::span<const int> meshOf) : trees_(std::make_unique<Trees>()), unit_(scene.info.unit()) {
    origin_ = scene.info.bounds.empty() ? glm::dvec3(0) : scene.info.bounds.lo;
    trees_->device.reset(rtcNewDevice(nullptr));
    if (!trees_->device) check(nullptr);
    RTCDevice device = trees_->device.get();
    trees_->top = makeScene(device);
    std::vector<int> uses(meshes.size(), 0);
    for (const int mesh : meshOf) ++uses[static_cast<std::size_t>(mesh)];
    std::vector<RTCScene> shared(meshes.size(), nullptr);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto number = static_cast<std::size_t>(meshOf[i]);
        const TriMesh& mesh = meshes[number];
        if (mesh.indices.empty()) continue;
        const glm::dmat4& world = scene.instances[i].worldFromMesh;
        const glm::dmat3 linear = glm::dmat3(world) * unit_;
        const glm::dvec3 offset = (glm::dvec3(world * glm::dvec4(mesh.pivot, 1)) - origin_) * unit_;
        if (uses[number] == 1) {
            addTriangles(device, trees_->top.get(), mesh, linear, offset);
            continue;
        }
        if (!shared[number]) {
            trees_->shared.push_back(makeScene(device));
            shared[number] = trees_->shared.back().get();
            addTriangles(device, shared[number], mesh, glm::dmat3(1), glm::dvec3(0));
            rtcCommitScene(shared[number]);
            check(device);
        }
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, shared[number]);
        float columns[12];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) columns[3 * column + row] = static_cast<float>(column < 3 ? linear[column][row] : offset[row]);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometry(trees_->top.get(), instance);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(trees_->top.get());
    check(device);
}

RayScene::~RayScene() = default;

glm::dmat4 RayScene::raysFromView(const View& view) const {
    // viewFromRelative is a rotation times view.unit, which is also ours.
    glm::dmat4 m(glm::transpose(view.viewFromRelative) / view.unit);
    m[3] = glm::dvec4((view.eye - origin_) * unit_, 1);
    return m;
}

RTCSceneTy* RayScene::handle() const { return trees_->top.get(); }

}  // namespace limn
