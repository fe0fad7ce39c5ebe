// Content keys of what a scene is made of: what has the same key at two frames need not be made, uploaded or drawn
// again.
#pragma once

#include "base/content_key.h"
#include "mesh/subdivide.h"
#include "scene/scene.h"

#include <map>
#include <string>

namespace limn {

/// The keys of image files, by their names.
using ImageKeys = std::map<std::string, ContentKey>;

/// Of everything about a material that a picture can show, the bytes of its images among it.
ContentKey materialKey(const Material& material, const ImageKeys& images);
/// Of the material's images alone; of none where it has none.
ContentKey textureKey(const Material& material, const ImageKeys& images);
/// Of everything about a light.
ContentKey lightKey(const Light& light);
/// Of how a mesh is to be subdivided; of the rates of its edges only that there are some.
void addSubdivision(KeyBuilder& key, const SubdivisionOptions& options);

}  // namespace limn
