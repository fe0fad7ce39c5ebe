#include "base/install.h"

namespace limn {

const std::string_view kVersion = LIMN_VERSION;

std::filesystem::path moduleFolder() {
    const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const auto installed = program.parent_path() / "lib" / "limn";
    return std::filesystem::exists(installed / "limn-oiio.so") ? installed : program;
}

}  // namespace limn
