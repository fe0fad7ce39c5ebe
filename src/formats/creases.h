// Creases and corners from a file of their own, for meshes whose format has no place for them.
#pragma once

#include "mesh/poly_mesh.h"

#include <filesystem>
#include <vector>

namespace limn {

/// Adds to the mesh's tags. The file is TOML: `creases = [[vertex, vertex, sharpness], ...]`, `corners = [[vertex,
/// sharpness], ...]`, with vertices counted from 0 and 10 for infinitely sharp. Throws Errors (badData) for what is not
/// in the mesh, and those of reading.
/// What was read, includes among it, is added to `files`.
void readCreases(
    const std::filesystem::path& path, PolyMesh& mesh, std::vector<std::filesystem::path>* files = nullptr);

}  // namespace limn
