// The triangles of a picture: the meshes that it needs, their content keys, and their making.
#pragma once

#include "mesh/tri_mesh.h"
#include "stage/scene_at.h"

#include <functional>
#include <map>
#include <vector>

namespace limn {

/// A mesh to be made: a file's polygons as triangles, subdivided and cut as the scene says.
struct MeshOrder {
    ContentKey key;                      ///< of everything that its triangles depend on
    std::size_t mesh = 0;                ///< index into SceneAt::meshes
    std::vector<std::size_t> instances;  ///< that show it: index into SceneAt::instances
    bool mayBeCut = false;               ///< sections may reach its only instance
    ContentKey whole;                    ///< where it may be cut: its content key if no section reaches it
};

struct MeshOrders {
    std::vector<MeshOrder> orders;
    std::map<ContentKey, MeshOrder> wholes;  ///< the order of each uncut mesh, by its content key
    std::vector<std::size_t> orderOf;        ///< of each instance: index into orders
    MeshNeeds needs;
};

/// Instances share meshes where they can. Where edges are cut to look smooth to the camera, only instances that look
/// about equally large share one. An instance that sections may reach has a mesh of its own.
MeshOrders orderMeshes(
    const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request, const MeshNeeds& needs);

/// The meshes that were made.
struct MadeMeshes {
    std::map<ContentKey, TriMesh> meshes;
    std::map<ContentKey, ContentKey> shownAs;  ///< of orders that no section reached: the whole mesh's content key
    double milliseconds = 0;
};

/// Makes the ordered meshes that `isWanted` accepts, in parallel. Warns of outlines of sections that do not close.
MadeMeshes makeMeshes(const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request,
    const MeshOrders& orders, const std::function<bool(const MeshOrder&)>& isWanted);

}  // namespace limn
