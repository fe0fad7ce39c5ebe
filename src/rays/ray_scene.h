// A scene's triangles for rays, with Embree in robust (watertight) mode.
//
// Ray space: (world − origin) · unit, as float. The origin is a corner of the scene's box. The unit is a power of two
// that brings the box's diagonal to [1, 2). So scenes far away and of any size are the same scene to the bit, and
// coordinates lie in [0, 2).
#pragma once

#include "graph/graph.h"
#include "mesh/tri_mesh.h"
#include "picture/view.h"
#include "stage/scene_at.h"

#include <memory>
#include <span>

struct RTCSceneTy;

namespace limn {

class RayScene : public HostScene {
public:
    /// Builds the tree. `meshOf`: the mesh of each instance of the scene. A mesh with one instance is built in place;
    /// several instances share one tree. Keeps no reference to the meshes. Throws Error (out of memory).
    RayScene(const SceneAt& scene, std::span<const TriMesh* const> meshOf);
    ~RayScene() override;
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Ray space from normalized view space.
    glm::dmat4 raysFromView(const View& view) const;

    RTCSceneTy* handle() const;

private:
    struct Trees;
    std::unique_ptr<Trees> trees_;
    glm::dvec3 origin_{0};
    double unit_ = 1;
};

}  // namespace limn
