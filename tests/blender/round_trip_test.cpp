// Through the real Blender and back: what our exporter writes, limn must make into what Blender itself evaluates and
// draws.

#include "formats/obj.h"
#include "image/codecs.h"
#include "mesh/topology.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class RoundTrip : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (std::system("command -v blender >/dev/null 2>&1") != 0) return;
        folder() = fs::temp_directory_path() / fmt::format("limn-round-trip-{}", ::getpid());
        const std::string source = LIMN_SOURCE_DIR;
        const std::string command = fmt::format(
            "blender -b --python-exit-code 1 -P '{0}/tests/blender/round_trip.py' -- '{0}/src/blender/export.py' '{1}' "
            "> '{1}.log' 2>&1",
            source, folder().string());
        ran() = std::system(command.c_str());
    }
    static void TearDownTestSuite() {
        if (folder().empty()) return;
        fs::remove_all(folder());
        fs::remove(folder().string() + ".log");
    }
    void SetUp() override {
        if (folder().empty()) GTEST_SKIP() << "Blender is not installed";
        ASSERT_EQ(ran(), 0) << "see " << folder().string() << ".log";
    }
    static fs::path& folder() {
        static fs::path path;
        return path;
    }
    static int& ran() {
        static int status = 0;
        return status;
    }
};

double diagonal(const std::vector<glm::dvec3>& points) {
    Bounds bounds;
    for (const auto& p : points) bounds.add(p);
    return bounds.diagonal();
}

TEST_F(RoundTrip, pointsAndUvsAreBlenders) {
    const LoadedScene loaded = loadScene(folder() / "scene.toml");
    int compared = 0;
    const auto meshes = loaded.meshes->at(1);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const auto& source = loaded.scene.meshes[i];
        const auto options = subdivisionOf(source, meshes[i]->poly);
        if (!options) continue;
        EXPECT_EQ(options->limit, source.name.ends_with("_limit"));
        const PolyMesh ours = refineUniformly(meshes[i]->poly, *options, false);
        const PolyMesh theirs = readObj(folder() / "truth" / (source.name + ".obj")).mesh;
        // Blender's own patches reach the limit of the sharpest semi-sharp creases (8.1) to 2.3e-5 only, at its highest
        // quality.
        const double reach = (source.name == "creased_limit" ? 3e-5 : 1e-5) * diagonal(theirs.positions);
        EXPECT_EQ(ours.faceCount(), theirs.faceCount()) << source.name;
        ASSERT_EQ(ours.positions.size(), theirs.positions.size()) << source.name;
        // Every corner of Blender's must have one of ours at its place with its UV.
        double worst = 0;
        std::size_t astray = 0;
        for (std::size_t c = 0; c < theirs.cornerPosition.size(); ++c) {
            const auto& place = theirs.positions[theirs.cornerPosition[c]];
            const bool hasUv = !theirs.uvs.empty();
            double nearest = 1e9;
            bool uvFound = !hasUv;
            for (std::size_t o = 0; o < ours.cornerPosition.size(); ++o) {
                const double distance = glm::distance(place, ours.positions[ours.cornerPosition[o]]);
                nearest = std::min(nearest, distance);
                uvFound = uvFound
                    || (distance <= reach
                        && glm::distance(theirs.uvs[static_cast<std::size_t>(theirs.cornerUv[c])],
                               ours.uvs[static_cast<std::size_t>(ours.cornerUv[o])])
                            <= 1e-5f);
            }
            worst = std::max(worst, nearest);
            astray += !uvFound;
        }
        EXPECT_LE(worst, reach) << source.name;
        EXPECT_EQ(astray, 0u) << source.name << ": corners whose UV is elsewhere, of " << theirs.cornerPosition.size();
        ++compared;
    }
    EXPECT_EQ(compared, 10);
}

TEST_F(RoundTrip, lineColoursComeAlong) {
    const LoadedScene loaded = loadScene(folder() / "scene.toml");
    int inked = 0;
    for (const auto& material : loaded.scene.materials) {
        EXPECT_EQ(material.base.lineColor.given, material.base.name == "inked") << material.base.name;
        if (material.base.name != "inked") continue;
        ++inked;
        EXPECT_NEAR(material.base.lineColor.color.r, 0.8, 1e-4);
        EXPECT_NEAR(material.base.lineColor.color.g, 0.1, 1e-4);
    }
    EXPECT_EQ(inked, 1);
}

TEST_F(RoundTrip, coloursAndHolesComeAlong) {
    const LoadedScene loaded = loadScene(folder() / "scene.toml");
    int painted = 0, cut = 0;
    for (const auto& mesh : loaded.meshes->at(1)) {
        if (mesh->poly.colors.empty()) continue;
        ++painted;
        const glm::vec3 expected[] = {{1, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.25f}, {1, 1, 1}};
        ASSERT_EQ(mesh->poly.colors.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(glm::distance(mesh->poly.colors[i], expected[i]), 1e-5f) << i;
    }
    for (const auto& material : loaded.scene.materials) {
        EXPECT_EQ(material.base.vertexColors, material.base.name == "paint") << material.base.name;
        EXPECT_EQ(material.base.cutout.empty(), material.base.name != "leaf") << material.base.name;
        if (material.base.cutout.empty()) continue;
        ++cut;
        EXPECT_EQ(material.base.cutout, material.base.texture) << "one image serves as both";
        const Image image = readImage(material.base.cutout);
        ASSERT_EQ(image.channels, 4);
        EXPECT_EQ(image.at(1, 1)[3], 1);
        EXPECT_EQ(image.at(6, 1)[3], 0);
    }
    EXPECT_EQ(painted, 1);
    EXPECT_EQ(cut, 1);
}

TEST_F(RoundTrip, copiesButForRoundingAreOneMesh) {
    const LoadedScene loaded = loadScene(folder() / "scene.toml");
    std::map<std::string, std::string> mesh;
    for (const auto& instance : loaded.scene.instances) mesh[instance.base.name] = instance.base.mesh;
    ASSERT_TRUE(mesh.contains("twin0") && mesh.contains("twin1") && mesh.contains("twin2"));
    EXPECT_EQ(mesh["twin0"], mesh["twin1"]);
    EXPECT_NE(mesh["twin0"], mesh["twin2"]);
}

TEST_F(RoundTrip, outlinesAreBlendersWithinAPixel) {
    for (const char* camera : {"plain", "shifted", "upright_sensor", "orthographic"}) {
        ConfigOverrides overrides;
        overrides.settings = {"image.samples=1", "output.aovs=['object_id']"};
        const RenderConfig config = readRenderConfig(folder() / (std::string(camera) + ".toml"), overrides);
        const Picture ours = draw(config, loadScene(config.scene));
        const Image theirs = readImage((folder() / "truth" / (std::string(camera) + ".png")).string());
        const Image& ids = ours.aov("object_id");
        ASSERT_EQ(ids.width, theirs.width);
        ASSERT_EQ(ids.height, theirs.height);
        const auto weSee = [&](int x, int y) { return ids.at(x, y)[0] > 0; };
        const auto theySee = [&](int x, int y) { return theirs.at(x, y)[3] > 0.5f; };
        int astray = 0, covered = 0;
        for (int y = 1; y + 1 < ids.height; ++y)
            for (int x = 1; x + 1 < ids.width; ++x) {
                covered += theySee(x, y);
                if (weSee(x, y) == theySee(x, y)) continue;
                // Where they differ, both must have seen it the other way next door.
                bool near = false;
                for (int v = -1; v <= 1; ++v)
                    for (int u = -1; u <= 1; ++u) near = near || (weSee(x + u, y + v) == theySee(x, y));
                astray += !near;
            }
        EXPECT_EQ(astray, 0) << camera;
        EXPECT_GT(covered, 5000) << camera;
    }
}

// What a person has edited stays: configs, and the file that the scene includes.
TEST_F(RoundTrip, aSecondExportLeavesAloneWhatPeopleEdit) {
    const fs::path own = folder() / "scene_own.toml";
    ASSERT_TRUE(fs::exists(own));
    std::vector<fs::path> configs;
    for (const auto& entry : fs::directory_iterator(folder()))
        if (entry.path().extension() == ".toml" && entry.path().stem().string().find("scene") == std::string::npos)
            configs.push_back(entry.path());
    ASSERT_FALSE(configs.empty());
    std::ofstream(configs.front(), std::ios::app) << "# mine\n";
    std::ofstream(own, std::ios::app) << "[[light]]\nname = \"mine\"\nkind = \"point\"\n";
    SetUpTestSuite();
    ASSERT_EQ(ran(), 0);
    std::ifstream config(configs.front());
    const std::string text{std::istreambuf_iterator<char>(config), {}};
    EXPECT_TRUE(text.ends_with("# mine\n"));
    const LoadedScene loaded = loadScene(folder() / "scene.toml");
    EXPECT_TRUE(std::any_of(loaded.scene.lights.begin(), loaded.scene.lights.end(),
        [](const auto& light) { return light.base.name == "mine"; }));
}

}  // namespace
}  // namespace limn::test
