// Content keys of a scene's parts: a part with the same content key at two frames need not be made, uploaded or drawn
// again.
#pragma once

#include "base/content_key.h"
#include "mesh/subdivide.h"
#include "scene/scene.h"

#include <map>
#include <string>

namespace limn {

/// The content keys of image files, by file name.
using ImageKeys = std::map<std::string, ContentKey>;

/// Covers everything about a material that a picture can show, the bytes of its images included.
ContentKey materialKey(const Material& material, const ImageKeys& images);
/// Covers the material's images alone; empty if it has none.
ContentKey textureKey(const Material& material, const ImageKeys& images);
/// Covers everything about a light.
ContentKey lightKey(const Light& light);
/// Adds how a mesh is to be subdivided; of its edge rates only that there are some.
void addSubdivision(KeyBuilder& key, const SubdivisionOptions& options);

}  // namespace limn
