// The scene at one frame: everything resolved, nothing that changes, and no GL.
#pragma once

#include "lines/record.h"
#include "picture/view.h"
#include "stage/loaded_scene.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

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

/// One mesh, placed.
struct DrawInstance {
    int mesh = 0;
    glm::dmat4 worldFromMesh{1};
    std::vector<std::uint32_t> materials;    ///< of each of the mesh's material names: index into SceneAt::materials
    std::uint32_t firstObject = 1;           ///< object_id of the mesh's first part
    std::string_view name;                   ///< of the instance in the scene; as long as that lives, like:
    std::span<const std::string> parts;      ///< names of the mesh's parts
    std::vector<std::uint32_t> lineRecords;  ///< beside materials: index into SceneAt::lineRecords
    bool hasColors = false;                  ///< the mesh has vertex colours
    std::uint64_t mostTriangles = 0;         ///< that may be made of the mesh, sections aside
};

/// A plane that cuts the scene open. Beyond it, on its normal's side, nothing is drawn.
struct SectionPlane {
    glm::dvec3 point{0}, normal{0, 0, 1};
    bool operator==(const SectionPlane&) const = default;
};

/// Made by sceneAt(), and never changed after. Parts' names point into the meshes, which it keeps alive; instances'
/// names into the loaded scene, which must outlive it.
struct SceneAt {
    double frame = 1;
    std::vector<SharedMesh> meshes;  ///< beside Scene::meshes; null where no instance draws one
    std::vector<DrawInstance> instances;
    std::vector<Material> materials;
    std::vector<LineRecord> lineRecords{LineRecord()};  ///< the first says nothing
    std::vector<Light> lights;
    std::vector<SectionPlane> sections;  ///< cut faces have the materials after the instance's own, one per section
    Camera camera;
    SceneInfo info;
    std::vector<ContentKey> materialKeys, textureKeys;  ///< beside materials
    std::vector<ContentKey> lightKeys;                  ///< beside lights; of meshes: MeshFile::key
    ContentKey key;                                     ///< of every file that went in
};

/// The scene at a frame; reads the files of meshes that have one for each. Throws Error where there is no such camera
/// or section, or the camera cannot draw to scale, and what reading throws.
SceneAt sceneAt(const LoadedScene& loaded, const FrameRequest& request);

/// What effects know of the scene as a whole; the same at every frame.
SceneInfo sceneInfo(const LoadedScene& loaded);
/// The camera alone.
Camera cameraAt(const LoadedScene& loaded, const FrameRequest& request);

}  // namespace limn
