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
    std::vector<Material> materials;  ///< of its MTL files
    std::vector<MeshWarning> warnings;
};

/// Index into Scene::meshes.
std::size_t meshIndex(const Scene& scene, const std::string& name);

/// How a mesh of the scene is to be subdivided, tags and settings together; nullopt: not at all. `edgeRate` is left
/// out.
std::optional<SubdivisionOptions> subdivisionOf(const MeshSource& source, const PolyMesh& mesh);

struct LoadedScene {
    Scene scene;
    std::vector<LoadedMesh> meshes;  ///< beside Scene::meshes; empty where no instance draws the mesh
    Bounds bounds;                   ///< of the drawn instances at the first declared frame
    std::string hash;                ///< of every file that went in
    std::uint64_t sceneHash = 0;     ///< of those that are no meshes
    std::vector<std::uint64_t> meshHashes;
    int frame = 1;             ///< at which meshes that have a file per frame stand
    std::uint64_t number = 0;  ///< tells one loaded scene from another within the process
};

/// What loadScene does once the meshes are there: bounds, hash, number. For scenes that do not come from files.
void finishLoading(LoadedScene& loaded);

/// Reads the scene that a config names and every mesh that is drawn, in parallel; those with a file per frame at the
/// first declared one. All problems at once (Errors).
LoadedScene loadScene(const std::filesystem::path& path);
/// The scene of a config. Throws Error (usage) where `subdivide` is asked of a scene that says itself what is
/// subdivided.
LoadedScene loadScene(const RenderConfig& config);

/// Reads the meshes that have a file per frame anew, where that is another frame. What is relative to the scene's size
/// stays relative to the first.
void goToFrame(LoadedScene& loaded, int frame);

/// What a picture wants of a scene.
struct FrameRequest {
    std::string file;    ///< who asks: a config, for messages
    std::string camera;  ///< empty: the first, or one that frames the scene
    double frame = 1;
    glm::ivec2 imageSize{1280, 720};
    double dpi = 96;
    std::vector<std::string> sections;  ///< names of those to cut by, beside those without a name
    double scale = 0;                   ///< of a drawing on paper, 1/50 for example; 0: as the camera says
};
FrameRequest frameRequest(const RenderConfig& config, double frame);

/// The scene at a frame. Throws Error where there is no such camera or section, or the camera cannot draw to scale.
DrawScene resolveFrame(const LoadedScene& loaded, const FrameRequest& request);

/// Number of textured materials that are drawn, and whether a light is coloured: what effects build on.
SceneFacts sceneFacts(const DrawScene& scene);

}  // namespace limn
