#include "formats/format.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>
#include <cassert>

namespace limn {
namespace {

template <class Format>
std::vector<const Format*>& registry() {
    static std::vector<const Format*> formats;
    return formats;
}

/// The linker's order is no order: by extension.
template <class Format>
void insert(const Format* format) {
    auto& all = registry<Format>();
    const auto before = [](const Format* a, const Format* b) { return a->extension < b->extension; };
    all.insert(std::upper_bound(all.begin(), all.end(), format, before), format);
}

template <class Format>
const Format* find(std::string_view extension) {
    for (const auto* format : registry<Format>())
        if (format->extension == extension) return format;
    return nullptr;
}

template <class Format>
const Format& formatOr(const std::filesystem::path& path, std::string_view standard) {
    const Format* format = find<Format>(lowerCase(path.extension().string()));
    if (!format) format = find<Format>(standard);
    assert(format);
    return *format;
}

}  // namespace

MeshFormat::MeshFormat(
    std::string_view extension_, std::string_view doc_, MeshFile (*read_)(const std::filesystem::path&))
    : extension(extension_), doc(doc_), read(read_) {
    insert(this);
}

SceneFormat::SceneFormat(
    std::string_view extension_, std::string_view doc_, SceneFile (*read_)(const std::filesystem::path&))
    : extension(extension_), doc(doc_), read(read_) {
    insert(this);
}

const std::vector<const MeshFormat*>& meshFormats() { return registry<MeshFormat>(); }
const std::vector<const SceneFormat*>& sceneFormats() { return registry<SceneFormat>(); }

const MeshFormat& meshFormat(const std::filesystem::path& path) { return formatOr<MeshFormat>(path, ".obj"); }
const SceneFormat& sceneFormat(const std::filesystem::path& path) { return formatOr<SceneFormat>(path, ".toml"); }

void requireFaces(const MeshFile& mesh) {
    if (mesh.poly.faceCount() == 0 && mesh.poly.lines.empty())
        throw Error(ExitCode::badData, {mesh.files.front().string()}, "there are no faces and no lines",
            "limn draws polygons and polylines: export the model with faces");
}

Scene sceneOfMesh(const std::filesystem::path& path) {
    Scene scene;
    scene.file = path.string();
    const std::string name = path.stem().string();
    scene.meshes.push_back({.name = name, .file = path.string()});
    Keyed<Instance>& instance = scene.instances.emplace_back();
    instance.base.name = instance.base.mesh = name;
    return scene;
}

bool isMeshFile(const std::filesystem::path& path) {
    return find<MeshFormat>(lowerCase(path.extension().string())) != nullptr;
}

}  // namespace limn
