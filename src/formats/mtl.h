// Materials of MTL libraries.
#pragma once

#include "mesh/poly_mesh.h"
#include "scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

struct MtlFile {
    std::vector<Material> materials;     ///< colours linear Rec.709, as MTL's are taken
    std::vector<std::string> invisible;  ///< names of materials with d 0
    std::vector<MeshWarning> warnings;   ///< what was ignored or mended, once per kind
};

/// Reads a library. Images are looked for beside it, in `folder`, and below (formats/find_file.h). Nothing in a library
/// is an error: what has no meaning is a warning. Throws Error (badData) where the bytes are no text (ModelText);
/// `name` stands for the file in messages.
MtlFile parseMtl(std::string_view bytes, const std::filesystem::path& folder, const std::string& name = "MTL");

/// The materials of all libraries that an OBJ names, looked for beside it. A missing library is a warning. Libraries
/// that were read are added to `files`. Faces of invisible materials are dropped from the mesh; where no face names a
/// material and there is one only, it goes to all.
std::vector<Material> readMaterials(const std::filesystem::path& objPath, PolyMesh& mesh,
    std::vector<MeshWarning>& warnings, std::vector<std::filesystem::path>* files = nullptr);

}  // namespace limn
