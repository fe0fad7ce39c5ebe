// Mesh files that others made to be hard: what each must come to, as tests/errors/hard_meshes.tsv says.

#include "formats/inspect.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>

namespace limn::test {
namespace {

/// Exit code, faces and kinds of warning, as a line of the manifest.
std::string outcome(const std::filesystem::path& path) {
    const auto general = [](const std::string& kind) {
        return std::regex_replace(kind, std::regex("^(texture|material library) '.*?'"), "$1 '...'");
    };
    try {
        const MeshFacts facts = inspectMesh(path);
        std::string kinds;
        for (const auto& warning : facts.warnings)
            kinds += fmt::format("{}{} x{}", kinds.empty() ? "" : " | ", general(warning.kind), warning.count);
        return fmt::format("0\t{}\t{}", facts.faces, kinds);
    } catch (const Error& error) { return fmt::format("{}\t0\t{}", static_cast<int>(error.code), error.problem); }
}

TEST(HardMeshes, comeToWhatTheManifestSays) {
    const char* data = std::getenv("LIMN_TEST_DATA");
    if (!data) GTEST_SKIP() << "LIMN_TEST_DATA names no folder of test data";
    std::ifstream manifest(std::string(LIMN_SOURCE_DIR) + "/tests/errors/hard_meshes.tsv");
    std::string line;
    int checked = 0;
    while (std::getline(manifest, line)) {
        if (line.empty() || line[0] == '#') continue;
        const auto tab = line.find('\t');
        EXPECT_EQ(outcome(std::filesystem::path(data) / line.substr(0, tab)), line.substr(tab + 1))
            << line.substr(0, tab);
        ++checked;
    }
    EXPECT_EQ(checked, 87);
}

}  // namespace
}  // namespace limn::test
