#include "rays/ray_scene.h"

#include "rays/embree.h"
#include "rays/holes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr TreePurpose kPurpose{"the ray tracing tree", "use coarser meshes, or a screen-space technique"};

EmbreeScene makeScene(RTCDevice device) {
    EmbreeScene scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

/// Data of Embree's filter, which lets rays through the holes of a mesh.
struct Holes {
    std::vector<const Mask*> mask;  ///< of each triangle; null: it has none
    std::vector<glm::vec2> uvs;     ///< three per triangle, in the mask's coordinates
};

void ignoreHoles(const RTCFilterFunctionNArguments* call) {
    const auto& holes = *static_cast<const Holes*>(call->geometryUserPtr);
    for (unsigned i = 0; i < call->N; ++i) {
        if (call->valid[i] == 0) continue;
        const std::size_t triangle = RTCHitN_primID(call->hit, call->N, i);
        if (!holes.mask[triangle]) continue;
        const float u = RTCHitN_u(call->hit, call->N, i), v = RTCHitN_v(call->hit, call->N, i);
        const glm::vec2* uv = holes.uvs.data() + 3 * triangle;
        if (alphaAt(*holes.mask[triangle], uv[0] + u * (uv[1] - uv[0]) + v * (uv[2] - uv[0])) < 0.5f)
            call->valid[i] = 0;
    }
}

void addTriangles(RTCDevice device, RTCScene scene, const TriMesh& mesh, const glm::dmat3& linear,
    const glm::dvec3& offset, Holes* holes = nullptr) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangleCount()));
    if (vertices && indices) {
        tbb::parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t i) {
            const glm::vec3 p(linear * glm::dvec3(mesh.positions[i]) + offset);
            for (int k = 0; k < 3; ++k) vertices[3 * i + static_cast<std::size_t>(k)] = p[k];
        });
        std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
        if (holes) {
            rtcSetGeometryUserData(geometry, holes);
            rtcSetGeometryIntersectFilterFunction(geometry, ignoreHoles);
            rtcSetGeometryOccludedFilterFunction(geometry, ignoreHoles);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    checkEmbree(device, kPurpose);
}

}  // namespace

struct RayScene::Trees {
    EmbreeDevice device;
    std::vector<EmbreeScene> shared;
    EmbreeScene top;
    HoleMasks masks;
    std::vector<std::unique_ptr<Holes>> holes;

    Holes* holesOf(const TriMesh& mesh, const std::vector<const Mask*>& maskOf) {
        if (maskOf.empty()) return nullptr;
        auto& made = *holes.emplace_back(std::make_unique<Holes>());
        made.mask.reserve(mesh.triangleCount());
        made.uvs.reserve(3 * mesh.triangleCount());
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
            const Mask* mask = maskOf[mesh.triangleMaterial.empty() ? 0 : mesh.triangleMaterial[t]];
            made.mask.push_back(mask);
            for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
                const glm::vec2 uv = mesh.uvs[mesh.uvIndices.empty() ? mesh.indices[k] : mesh.uvIndices[k]];
                made.uvs.push_back(mask ? uv * mask->scale + mask->offset : uv);
            }
        }
        return &made;
    }
};

RayScene::RayScene(const SceneAt& scene, std::span<const TriMesh* const> meshOf)
    : trees_(std::make_unique<Trees>()), unit_(scene.info.unit()) {
    origin_ = scene.info.bounds.empty() ? glm::dvec3(0) : scene.info.bounds.lo;
    trees_->device = makeEmbreeDevice();
    RTCDevice device = trees_->device.get();
    trees_->top = makeScene(device);
    // Instances share a tree if they share a mesh and its holes.
    using Look = std::pair<const TriMesh*, std::vector<const Mask*>>;
    std::vector<Look> looks;
    std::map<Look, int> uses;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        ++uses[looks.emplace_back(meshOf[i], trees_->masks.of(scene, scene.instances[i]))];
    std::map<Look, RTCScene> shared;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const TriMesh& mesh = *meshOf[i];
        if (mesh.indices.empty()) continue;
        const glm::dmat4& world = scene.instances[i].worldFromMesh;
        const glm::dmat3 linear = glm::dmat3(world) * unit_;
        const glm::dvec3 offset = (glm::dvec3(world * glm::dvec4(mesh.pivot, 1)) - origin_) * unit_;
        const Look& look = looks[i];
        if (uses[look] == 1) {
            addTriangles(device, trees_->top.get(), mesh, linear, offset, trees_->holesOf(mesh, look.second));
            continue;
        }
        RTCScene& tree = shared[look];
        if (!tree) {
            trees_->shared.push_back(makeScene(device));
            tree = trees_->shared.back().get();
            addTriangles(device, tree, mesh, glm::dmat3(1), glm::dvec3(0), trees_->holesOf(mesh, look.second));
            rtcCommitScene(tree);
            checkEmbree(device, kPurpose);
        }
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, tree);
        float columns[12];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                columns[3 * column + row] = static_cast<float>(column < 3 ? linear[column][row] : offset[row]);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometry(trees_->top.get(), instance);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(trees_->top.get());
    checkEmbree(device, kPurpose);
}

RayScene::~RayScene() = default;

glm::dmat4 RayScene::raysFromView(const View& view) const {
    // viewFromRelative is a rotation times view.unit, which is also ray space's unit.
    glm::dmat4 m(glm::transpose(view.viewFromRelative) / view.unit);
    m[3] = glm::dvec4((view.eye - origin_) * unit_, 1);
    return m;
}

RTCSceneTy* RayScene::handle() const { return trees_->top.get(); }

}  // namespace limn
