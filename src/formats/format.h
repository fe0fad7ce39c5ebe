// File formats, and where each makes itself known.
//
// A format is one file: src/formats/<name>.cpp ends with
//     const MeshFormat kObj{".obj", "what it is", readMesh};
// or a SceneFormat likewise, and nothing else knows that it exists. A reader returns what it read together with the
// names of all files that went into it.
#pragma once

#include "base/content_key.h"
#include "mesh/poly_mesh.h"
#include "scene/bounds.h"
#include "scene/scene.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace limn {

/// A mesh as its files give it.
struct MeshFile {
    PolyMesh poly;
    std::vector<Material> materials;           ///< that the file brings along
    std::vector<MeshWarning> warnings;         ///< what was mended on the way
    std::vector<std::filesystem::path> files;  ///< all that was read, the mesh file first; textures are not
    ContentKey key;                            ///< of every byte that the polygons came from
    Bounds bounds;                             ///< of all positions; made when the mesh is loaded
};

/// Throws Error (badData) where a mesh has no faces.
void requireFaces(const MeshFile& mesh);

struct MeshFormat {
    std::string_view extension;  ///< ".obj", in lower case
    std::string_view doc;
    MeshFile (*read)(const std::filesystem::path&);  ///< throws Error or Errors (badData, missingInput ...)

    MeshFormat(std::string_view extension_, std::string_view doc_, MeshFile (*read_)(const std::filesystem::path&));
    MeshFormat(const MeshFormat&) = delete;
    MeshFormat& operator=(const MeshFormat&) = delete;
};

/// A scene as its file describes it; the meshes that it names are not read.
struct SceneFile {
    Scene scene;
    std::vector<std::filesystem::path> files;  ///< all that was read, includes among it
};

struct SceneFormat {
    std::string_view extension, doc;
    SceneFile (*read)(const std::filesystem::path&);  ///< throws Error or Errors

    SceneFormat(std::string_view extension_, std::string_view doc_, SceneFile (*read_)(const std::filesystem::path&));
    SceneFormat(const SceneFormat&) = delete;
    SceneFormat& operator=(const SceneFormat&) = delete;
};

/// All that are known, by extension.
const std::vector<const MeshFormat*>& meshFormats();
const std::vector<const SceneFormat*>& sceneFormats();

/// The format of a file by its extension, in any case. A mesh of an unknown extension is taken for OBJ, a scene of one
/// for TOML.
const MeshFormat& meshFormat(const std::filesystem::path& path);
const SceneFormat& sceneFormat(const std::filesystem::path& path);

/// A scene of one mesh file, drawn as it is modelled.
Scene sceneOfMesh(const std::filesystem::path& path);
/// Is the file a mesh, drawn without a scene around it?
bool isMeshFile(const std::filesystem::path& path);

}  // namespace limn
