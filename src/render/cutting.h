// Scenes cut open by their sections.
#pragma once

#include "geometry/tri_mesh.h"
#include "render/loader.h"

namespace limn {

/// Cuts every instance that a section reaches; it then has a mesh of its own, added to `meshes` and named in `meshOf`.
/// Meshes that only cut instances showed are emptied. Warns of outlines that do not close.
void cutOpen(const LoadedScene& loaded, const DrawScene& scene, const MeshNeeds& needs, std::vector<TriMesh>& meshes,
    std::vector<int>& meshOf);

}  // namespace limn
