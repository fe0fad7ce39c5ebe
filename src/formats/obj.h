// Wavefront OBJ and MTL text.
//
// Our own reader, because a library that keeps line numbers, takes faces of any size, joins continued lines and checks
// every index does not exist (tinyobjloader stores a face's size in one byte; OpenMesh's reader writes out of bounds on
// a bad index).
#pragma once

#include "mesh/poly_mesh.h"
#include "scene/scene.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace limn {

struct ObjFile {
    PolyMesh mesh;
    std::vector<MeshWarning> warnings;
};

/// Reads an OBJ. What can be mended is mended with a warning; throws Error (badData) when nothing usable remains or
/// most faces point nowhere, and the errors of MappedFile when the file cannot be read. Parallel over the file; the
/// result does not depend on threads.
ObjFile readObj(const std::filesystem::path& path);
/// The same from text; `name` stands for the file in messages. `chunks` splits the work (0: by size).
ObjFile parseObj(std::string_view text, const std::string& name, int chunks = 0);

/// The materials of the MTL libraries that an OBJ names, found beside it. A missing library or texture is a warning:
/// the rest is drawn. Libraries that were read are added to `files`.
std::vector<Material> readMaterials(const std::filesystem::path& objPath, const PolyMesh& mesh,
    std::vector<MeshWarning>& warnings, std::vector<std::filesystem::path>* files = nullptr);
std::vector<Material> parseMtl(
    std::string_view text, const std::filesystem::path& folder, std::vector<MeshWarning>& warnings);

}  // namespace limn
