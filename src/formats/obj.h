// Wavefront OBJ text.
//
// Our own reader, because a library that keeps line numbers, takes faces of any size, joins continued lines and checks
// every index does not exist (tinyobjloader stores a face's size in one byte; OpenMesh's reader writes out of bounds on
// a bad index).
#pragma once

#include "mesh/poly_mesh.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace limn {

struct ObjFile {
    PolyMesh mesh;
    std::vector<MeshWarning> warnings;
};

/// Reads an OBJ. What can be mended is mended with a warning; a file without faces gives a mesh without. Throws Error
/// (badData) when no face is usable, most faces point nowhere, or the file is something else, and the errors of
/// MappedFile when the file cannot be read. Parallel over the file; the result does not depend on threads.
ObjFile readObj(const std::filesystem::path& path);
/// The same from text; `name` stands for the file in messages. `chunks` splits the work (0: by size).
ObjFile parseObj(std::string_view text, const std::string& name, int chunks = 0);

}  // namespace limn
