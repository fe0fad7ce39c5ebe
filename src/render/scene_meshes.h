// The triangles of a scene as a config wants them: tessellated, cut open, one mesh for all instances that can share it.
#pragma once

#include "render/loader.h"

namespace limn {

/// What decides about what is brought to the GPU, and to rays: while it stays the same, so does that.
struct SceneKey {
    std::uint64_t scene = 0;  ///< LoadedScene::number
    SceneData needs = SceneData::none;
    std::string fittedTo;            ///< camera and picture that edges are cut for; empty when none are
    std::vector<glm::dmat4> places;  ///< where instances stand, if they are cut or hit by rays
    std::vector<SectionPlane> sections;
    bool operator==(const SceneKey&) const = default;
};
SceneKey sceneKey(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneData needs);

struct SceneMeshes {
    SceneKey key;
    std::vector<TriMesh> meshes;
    std::vector<int> meshOf;  ///< of each instance: which of them
    double milliseconds = 0;  ///< that it took to make them
};

/// In parallel. Needs no GL.
SceneMeshes buildMeshes(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneKey key);

/// The same for a frame of a config that has not been planned yet: to begin with it while a device starts.
SceneMeshes buildMeshes(const RenderConfig& config, const LoadedScene& loaded, int frame);

}  // namespace limn
