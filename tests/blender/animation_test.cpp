// Animations out of the real Blender: keys where things move, one file where they are rigid, a file per frame where
// they change their shape.

#include "base/file.h"
#include "formats/obj.h"
#include "formats/scene_file.h"
#include "scene/scene.h"
#include "settings/document.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace limn::test {
namespace {

namespace fs = std::filesystem;

TEST(Animation, ofBlenderIsWrittenFrameByFrame) {
    if (std::system("command -v blender >/dev/null 2>&1") != 0) GTEST_SKIP() << "Blender is not installed";
    const TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    const std::string source = LIMN_SOURCE_DIR;
    ASSERT_EQ(std::system(fmt::format("blender -b --python-exit-code 1 -P '{0}/tests/blender/animation.py' -- "
                                      "'{0}/src/blender/export.py' '{1}' > '{1}/log' 2>&1",
                  source, folder.string())
                              .c_str()),
        0)
        << readFile(folder / "log");

    const Scene scene = readScene(folder / "scene.toml");
    ASSERT_TRUE(scene.frames);
    EXPECT_EQ(scene.frames->first, 3);
    EXPECT_EQ(scene.frames->last, 9);
    EXPECT_NEAR(scene.fps, 24 / 1.001, 1e-4);
    const auto instance = [&](const std::string& name) -> const Keyed<Instance>& {
        for (const auto& keyed : scene.instances)
            if (keyed.base.name == name) return keyed;
        throw std::runtime_error("no instance " + name);
    };
    const auto mesh = [&](const std::string& name) -> const MeshSource& {
        for (const auto& known : scene.meshes)
            if (known.name == instance(name).base.mesh) return known;
        throw std::runtime_error("no mesh of " + name);
    };

    for (const char* name : {"mover", "child"}) EXPECT_TRUE(instance(name).moves()) << name;
    for (const char* name : {"rigid", "bending", "still"}) EXPECT_FALSE(instance(name).moves()) << name;
    for (const char* name : {"mover", "rigid", "still", "child"})
        EXPECT_TRUE(fs::exists(mesh(name).file)) << name << ": once for all frames";
    EXPECT_TRUE(mesh("bending").file.ends_with("_####.obj"));
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder / "meshes")) files += entry.path().extension() == ".obj";
    EXPECT_EQ(files, 7u + 2u) << "seven frames of one mesh, and two more: three cubes are one file";

    std::ifstream truth(folder / "truth.txt");
    int lines = 0;
    for (std::string line; std::getline(truth, line); ++lines) {
        std::istringstream words(line);
        int frame;
        std::string name;
        words >> frame >> name;
        if (name == "shape") {
            double widest, ours = 0;
            words >> widest;
            std::string file = mesh("bending").file;
            file.replace(file.find("####"), 4, fmt::format("{:04}", frame));
            for (const auto& p : readObj(file).mesh.positions) ours = std::max(ours, p.x);
            EXPECT_NEAR(ours, widest, 1e-5) << frame;
        } else if (name == "camera") {
            glm::dvec3 place;
            double lens;
            words >> place.x >> place.y >> place.z >> lens;
            const Camera camera = scene.cameras.front().at(frame);
            EXPECT_LT(glm::distance(camera.position, place), 1e-5) << frame;
            // Blender's lens is for a sensor of 36 mm across, as limn's is by default.
            EXPECT_NEAR(camera.focalLength * 36 / camera.sensorWidth, lens, 1e-4) << frame;
        } else {
            const glm::dmat4 ours = instance(name).at(frame).transform();
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column) {
                    double theirs;
                    words >> theirs;
                    // Floats in Blender, and turns that go through angles in degrees.
                    EXPECT_NEAR(ours[column][row], theirs, 2e-5) << name << " at " << frame;
                }
        }
    }
    EXPECT_EQ(lines, 7 * 7);
}

}  // namespace
}  // namespace limn::test
