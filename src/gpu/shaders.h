// GLSL sources: built into the program, or read from a folder during development.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace limn {

class ShaderLibrary {
public:
    /// `folder` empty: the sources built into the program. Throws Error (missingInput) where the folder holds none.
    explicit ShaderLibrary(std::filesystem::path folder = {});

    bool contains(const std::string& path) const;
    /// The source, with `#include "lib/x.glsl"` lines replaced by their files, each file once. Call from one thread.
    /// Throws Error.
    std::string load(const std::string& path) const;

private:
    std::string source(const std::string& path) const;
    void expand(const std::string& path, std::set<std::string>& seen, std::string& out) const;

    std::filesystem::path folder_;
    mutable std::map<std::string, std::string> loaded_;  ///< results of load(), for sources that cannot change
};

/// Made by CMake from shaders/.
std::string_view embeddedShader(std::string_view path);

}  // namespace limn
