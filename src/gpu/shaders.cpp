#include "gpu/shaders.h"

#include "base/error.h"
#include "base/file.h"

#include <fmt/format.h>

#include <sstream>

namespace limn {

ShaderLibrary::ShaderLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (folder_.empty() || std::filesystem::is_directory(folder_ / "lib")) return;
    throw Error(ExitCode::missingInput, {folder_.string()}, "holds no shaders of limn",
        "name the folder 'shaders' of limn's sources, or a copy of it");
}

bool ShaderLibrary::contains(const std::string& path) const {
    return folder_.empty() ? !embeddedShader(path).empty() : std::filesystem::exists(folder_ / path);
}

std::string ShaderLibrary::source(const std::string& path) const {
    if (!contains(path))
        throw Error(ExitCode::internal, {}, fmt::format("there is no shader '{}'", path),
            folder_.empty() ? "build limn again" : "check --shader-dir");
    return folder_.empty() ? std::string(embeddedShader(path)) : readFile(folder_ / path);
}

std::string ShaderLibrary::load(const std::string& path) const {
    if (const auto known = loaded_.find(path); known != loaded_.end()) return known->second;
    std::set<std::string> seen;
    std::string out;
    expand(path, seen, out);
    if (folder_.empty()) loaded_.emplace(path, out);  // sources of a folder may change
    return out;
}

void ShaderLibrary::expand(const std::string& path, std::set<std::string>& seen, std::string& out) const {
    if (!seen.insert(path).second) return;
    std::istringstream lines(source(path));
    std::string line;
    // GLSL numbers its sources, here in the order of inclusion.
    const auto number = seen.size() - 1;
    int count = 0;
    out += fmt::format("#line 1 {}\n", number);
    while (std::getline(lines, line)) {
        ++count;
        constexpr std::string_view include = "#include \"";
        if (line.starts_with(include)) {
            const auto end = line.find('"', include.size());
            expand(line.substr(include.size(), end - include.size()), seen, out);
            out += fmt::format("#line {} {}\n", count + 1, number);
        } else {
            out += line + "\n";
        }
    }
}

}  // namespace limn
