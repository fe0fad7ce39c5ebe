// Dependencies point one way: base → {image, config, scene, gl} → geometry → graph → frame → reference → effects →
// render → {study, cli}.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

namespace {

TEST(Arrows, includesPointOneWay) {
    const std::map<std::string, std::set<std::string>> allowed{
        {"base", {"base"}},
        {"image", {"base", "image"}},
        {"config", {"base", "config"}},
        {"scene", {"base", "config", "scene"}},
        {"geometry", {"base", "scene", "geometry"}},
        {"graph", {"base", "graph"}},
        {"gl", {"base", "graph", "gl"}},  // graph/format.h: the vocabulary of pixel formats
        {"frame", {"base", "image", "scene", "geometry", "gl", "graph", "frame"}},
        {"reference", {"base", "geometry", "frame", "reference"}},
        {"effects", {"base", "config", "graph", "frame", "reference", "effects"}},
        {"render",
            {"base", "image", "config", "scene", "geometry", "gl", "graph", "frame", "reference", "effects", "render"}},
        {"study", {"base", "image", "config", "frame", "reference", "effects", "render", "study"}},
        {"cli", {"base", "image", "gl", "render", "study", "cli"}},
    };
    int checked = 0;
    const std::filesystem::path source = std::filesystem::path(LIMN_SOURCE_DIR) / "src";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source)) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        const std::string room = std::filesystem::relative(entry.path(), source).begin()->string();
        if (!allowed.contains(room)) continue;  // main.cpp
        std::ifstream file(entry.path());
        std::string line;
        while (std::getline(file, line)) {
            if (!line.starts_with("#include \"")) continue;
            const std::string target = line.substr(10, line.find('/', 10) - 10);
            EXPECT_TRUE(allowed.at(room).contains(target)) << entry.path() << ": " << line;
            ++checked;
        }
    }
    EXPECT_GT(checked, 80);
}

}  // namespace
