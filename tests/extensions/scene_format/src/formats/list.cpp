// Scenes that are a list of mesh files, a line for each.

#include "base/file.h"
#include "formats/format.h"

#include <sstream>

namespace limn {
namespace {

SceneFile readList(const std::filesystem::path& path) {
    SceneFile file;
    file.files = {path};
    file.scene.file = path.string();
    std::istringstream lines(readFile(path));
    for (std::string line; std::getline(lines, line);) {
        const std::string name = std::filesystem::path(line).stem().string();
        file.scene.meshes.push_back({.name = name, .file = (path.parent_path() / line).string()});
        Instance& instance = file.scene.instances.emplace_back().base;
        instance.name = instance.mesh = name;
    }
    return file;
}

const SceneFormat kList{".list", "a list of mesh files", readList};

}  // namespace
}  // namespace limn
