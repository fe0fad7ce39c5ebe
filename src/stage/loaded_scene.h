// A scene with its files: what is loaded once, and what of it is read when a frame needs it.
#pragma once

#include "formats/format.h"
#include "mesh/subdivide.h"
#include "scene/bounds.h"
#include "stage/keys.h"

#include <memory>
#include <optional>
#include <vector>

namespace limn {

using SharedMesh = std::shared_ptr<const MeshFile>;

/// The mesh files of a scene, each read when it is first asked for. Of a mesh with a file for
/// each frame, the last two that were read are kept. May be used from several threads.
class MeshLibrary {
public:
    /// `isDrawn`: of each mesh, whether an instance draws it; the others are never read.
    MeshLibrary(std::vector<MeshSource> sources, std::vector<bool> isDrawn);
    ~MeshLibrary();

    /// The meshes at a frame, in the order of the sources; null where nothing draws one. Missing ones are read in
    /// parallel; their warnings are logged. Throws Errors: every problem at once.
    std::vector<SharedMesh> at(int frame) const;
    /// The keys of all images that the materials of the meshes read so far name.
    ImageKeys imageKeys() const;
    /// Every file that was read for what is there now, images among them.
    std::vector<std::filesystem::path> files() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

struct EdgeViewers;

struct LoadedScene {
    Scene scene;
    std::shared_ptr<const MeshLibrary> meshes;
    Bounds bounds;                             ///< of the drawn instances at the first declared frame
    std::vector<std::filesystem::path> files;  ///< that the scene itself came from, its materials' images among them
    ContentKey key;                            ///< of those
    ImageKeys images;                          ///< of the scene's own materials
    std::shared_ptr<EdgeViewers> viewers;      ///< what stage/edge_rates has found out
};

/// Index into Scene::meshes.
std::size_t meshIndex(const Scene& scene, const std::string& name);

/// How a mesh of the scene is to be subdivided, tags and settings together; nullopt: not at all. `edgeRate` is left
/// out.
std::optional<SubdivisionOptions> subdivisionOf(const MeshSource& source, const PolyMesh& mesh);

/// Reads a scene, or a mesh file as a scene of its own, and every mesh that its first declared frame draws. All
/// problems at once (Errors). Throws Error (usage) where there are options for a mesh file, and a scene says these
/// things itself.
LoadedScene loadScene(const std::filesystem::path& path, const MeshFileOptions& options = {});

}  // namespace limn
