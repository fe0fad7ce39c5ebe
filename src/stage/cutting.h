// Scenes cut open by their sections.
#pragma once

#include "stage/meshes.h"

#include <span>

namespace limn {

/// Cuts the instances of these orders that a section reaches; the others show the whole mesh. Takes whole meshes from
/// `made`, adds the cut ones under their orders' content keys, and removes whole meshes that nothing shows any more.
/// Warns of outlines that do not close.
void cutOpen(const SceneAt& scene, const MeshNeeds& needs, std::span<const MeshOrder* const> orders, MadeMeshes& made);

}  // namespace limn
