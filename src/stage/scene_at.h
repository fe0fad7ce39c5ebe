// The scene at one frame: everything is resolved, nothing changes, and there is no GL.
#pragma once

#include "lines/record.h"
#include "picture/view.h"
#include "stage/loaded_scene.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// A picture's request for a scene.
struct FrameRequest {
    std::string file;    ///< the asking config, for messages
    std::string camera;  ///< empty: the first, or one that frames the scene
    double frame = 1;
    glm::ivec2 imageSize{1280, 720};
    double dpi = 96;
    std::vector<std::string> sections;  ///< names of the sections to cut by, besides those without a name
    double scale = 0;                   ///< of a drawing on paper, for example 1/50; 0: from the camera
};

/// One mesh, placed.
struct DrawInstance {
    int mesh = 0;
    glm::dmat4 worldFromMesh{1};
    std::vector<std::uint32_t> materials;    ///< of each of the mesh's material names: index into SceneAt::materials
    std::uint32_t firstObject = 1;           ///< object_id of the mesh's first part
    std::string_view name;                   ///< of the instance in the scene; valid as long as that lives, like:
    std::span<const std::string> parts;      ///< names of the mesh's parts
    std::vector<std::uint32_t> lineRecords;  ///< parallel to materials: index into SceneAt::lineRecords
    bool hasColors = false;                  ///< the mesh has vertex colours
    bool hasLines = false;                   ///< the mesh draws lines of its own
    bool isSubdivided = false;               ///< the mesh is a cage
    std::uint64_t mostTriangles = 0;         ///< that may be made of the mesh, sections aside
    std::size_t source = 0;                  ///< index into Scene::instances: some may be hidden
};

/// A plane that cuts the scene open. Nothing is drawn on its normal's side.
struct SectionPlane {
    glm::dvec3 point{0}, normal{0, 0, 1};
    bool operator==(const SectionPlane&) const = default;
};

/// Made by sceneAt(), and never changed after. Names of parts point into the meshes, which it keeps alive. Names of
/// instances point into the loaded scene, which must outlive it.
struct SceneAt {
    double frame = 1;
    std::vector<SharedMesh> meshes;  ///< parallel to Scene::meshes; null where no instance draws one
    std::vector<DrawInstance> instances;
    std::vector<Material> materials;
    std::vector<LineRecord> lineRecords{LineRecord()};  ///< the first is empty
    std::vector<Light> lights;
    std::vector<SectionPlane>
        sections;  ///< cut faces have the materials after the instance's own: for each section as many, in their order
    Camera camera;
    SceneInfo info;
    std::vector<ContentKey> materialKeys, textureKeys;  ///< parallel to materials
    std::vector<ContentKey> lightKeys;                  ///< parallel to lights; of meshes: MeshFile::key
    ContentKey key;                                     ///< of every file that was read for it
};

/// The scene at a frame. Reads the files of meshes that have one for each frame. Throws Error where there is no such
/// camera or section, or the camera cannot draw to scale, and all that reading throws.
SceneAt sceneAt(const LoadedScene& loaded, const FrameRequest& request);

/// Facts for effects about the scene as a whole; the same at every frame.
SceneInfo sceneInfo(const LoadedScene& loaded);
/// The camera alone.
Camera cameraAt(const LoadedScene& loaded, const FrameRequest& request);

}  // namespace limn
