// Where the running program and its parts are.
#pragma once

#include <filesystem>
#include <string_view>

namespace limn {

/// The program's version, from CMakeLists.txt.
extern const std::string_view kVersion;

/// The folder that holds limn-oiio.so: beside the program in a build tree, ../lib/limn from it when installed.
std::filesystem::path moduleFolder();

}  // namespace limn
