// From scene files to what is drawn at a frame.
#pragma once

#include "frame/gpu_scene.h"
#include "geometry/subdivide.h"
#include "render/config.h"
#include "scene/obj.h"

namespace limn {

/// A mesh file, read.
struct LoadedMesh {
    PolyMesh poly;
    std::vector<Material> materials;        ///< of its MTL files
    std::vector<MeshWarning> warnings;
};

/// Index into Scene::meshes.
std::size_t meshIndex(const Scene& scene, const std::string& name);

/// How a mesh of the scene is to be subdivided, tags and settings together; nullopt: not at all. `edgeRate` is left out.
std::optional<SubdivisionOptions> subdivisionOf(const MeshSource& source, const PolyMesh& mesh);

struct LoadedScene {
    Scene scene;
    std::vector<LoadedMesh> meshes;         ///< beside Scene::meshes; empty where no instance draws the mesh
    Bounds bounds;                          ///< of the drawn instances at the first declared frame
    std::string hash;                       ///< of every file that went in
    std::uint64_t number = 0;               ///< tells one loaded scene from another within the process
};

/// What loadScene does once the meshes are there: bounds, hash, number. For scenes that do not come from files.
void finishLoading(LoadedScene& loaded);

/// Reads the scene that a config names and every mesh that is drawn, in parallel. All problems at once (Errors).
LoadedScene loadScene(const std::filesystem::path& path);
/// The scene of a config. Throws Error (usage) where `subdivide` is asked of a scene that says itself what is subdivided.
LoadedScene loadScene(const RenderConfig& config);

/// The scene at a frame. `cameraName` empty: the first camera, or one that frames the scene. Throws Error when there is no such camera.
DrawScene resolveFrame(const LoadedScene& loaded, const std::string& cameraName, double frame, glm::ivec2 imageSize);

/// Number of textured materials that are drawn, and whether a light is coloured: what effects build on.
SceneFacts sceneFacts(const DrawScene& scene);

}  // namespace limn
