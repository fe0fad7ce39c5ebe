#include "support/bench.h"

#include "base/file.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace limn::test {

Renderer& renderer() {
    gl::DeviceOptions options;
    options.debug = true;
    // Shaders from a folder, for those who try the tests on changed ones.
    const char* shaders = std::getenv("LIMN_SHADER_DIR");
    static Renderer instance(options, shaders ? shaders : "");
    return instance;
}

LoadedScene makeScene(const std::string& toml, const std::vector<std::pair<std::string, std::string>>& files) {
    // readScene checks that files exist: give it real ones.
    const TemporaryFolder folder;
    for (const auto& [name, text] : files) replaceFile(folder.path() / name, text);
    replaceFile(folder.path() / "scene.toml", toml);
    return loadScene(folder.path() / "scene.toml");
}

RenderConfig makeConfig(const std::string& toml) {
    return parseRenderConfig(parseDocument("scene = \"/dev/null\"\n" + toml, "test.toml"), "test.toml");
}

const Image& Picture::aov(const std::string& name) const {
    for (const auto& layer : frame.layers)
        if (layer.name == name) return layer.image;
    throw std::runtime_error("the test did not ask for " + name);
}

namespace {

constexpr double kOneSide = 1.02;

/// Is this picture the one that LIMN_TEST_ONE_SIDE changes, and this the way how?
bool isChanged(std::string_view how, int picture) {
    const char* wanted = std::getenv("LIMN_TEST_ONE_SIDE");
    return wanted && wanted == fmt::format("{} {}", how, picture);
}

LoadedScene throughALongerLens(LoadedScene scene) {
    for (auto& [camera, tracks] : scene.scene.cameras) {
        EXPECT_TRUE(tracks.empty()) << "keys would undo the change";
        if (camera.fov == 0 && camera.focalLength == 0) camera.focalLength = 35;  // what is meant by neither
        const double half = camera.fov / 360 * std::acos(-1.0);
        camera.fov = std::atan(std::tan(half) / kOneSide) * 360 / std::acos(-1.0);
        camera.focalLength *= kOneSide;
        camera.orthographicHeight /= kOneSide;
    }
    return scene;
}

}  // namespace

Picture draw(const RenderConfig& config, const LoadedScene& scene, const RenderOptions& options, int frame) {
    static int drawn = 0;
    ++drawn;
    const bool isLensChanged = isChanged("lens", drawn);
    Picture picture{renderer().render(config, isLensChanged ? throughALongerLens(scene) : scene, frame, options)};
    if (isChanged("values", drawn))
        for (auto& layer : picture.frame.layers)
            for (float& value : layer.image.pixels) value *= static_cast<float>(kOneSide);
    EXPECT_EQ(picture.frame.nonFinite, 0u);
    EXPECT_TRUE(renderer().device().debugMessages().empty()) << renderer().device().debugMessages().front();
    return picture;
}

std::string toml(const glm::dvec3& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

std::string cameraToml(
    const glm::dvec3& position, const glm::dvec3& lookAt, const std::string& lens, const glm::dvec3& up) {
    return fmt::format(
        "[[camera]]\nposition = {}\nlook_at = {}\nup = {}\n{}\n", toml(position), toml(lookAt), toml(up), lens);
}

namespace {

std::string vertex(const glm::dvec3& p) { return fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z); }

/// Collects OBJ text with indices relative to the end, so that pieces can be put one after another.
std::string boxFaces() {
    return "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
}

}  // namespace

std::string quadObj(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return vertex(a) + vertex(b) + vertex(c) + vertex(d) + "f -4 -3 -2 -1\n";
}

std::string boxObj(const glm::dvec3& lo, const glm::dvec3& hi) {
    std::string text;
    for (const double z : {lo.z, hi.z})
        for (const auto& [x, y] :
            {std::pair(lo.x, lo.y), std::pair(hi.x, lo.y), std::pair(hi.x, hi.y), std::pair(lo.x, hi.y)})
            text += vertex({x, y, z});
    return text + boxFaces();
}

std::string sphereObj(double radius, int sides) {
    std::string text;
    const int rings = sides / 2;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double theta = std::acos(-1.0) * r / rings, phi = 2 * std::acos(-1.0) * s / sides;
            text += vertex(radius
                * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)));
        }
    const int count = (rings + 1) * sides;
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const auto index = [&](int ring, int side) { return ring * sides + side % sides - count; };
            if (r > 0) text += fmt::format("f {} {} {}\n", index(r, s), index(r + 1, s + 1), index(r, s + 1));
            if (r + 1 < rings) text += fmt::format("f {} {} {}\n", index(r, s), index(r + 1, s), index(r + 1, s + 1));
        }
    return text;
}

std::string mixedObj(const glm::dvec3& offset, double scale) {
    const auto place = [&](glm::dvec3 p) { return (p + offset) * scale; };
    std::string text;
    const auto box = [&](const char* name, glm::dvec3 lo, glm::dvec3 hi) {
        text += fmt::format("o {}\n", name) + boxObj(place(lo), place(hi));
    };
    text += "o floor\n" + quadObj(place({-6, 0, 6}), place({6, 0, 6}), place({6, 0, -6}), place({-6, 0, -6}));
    text += "o wall\n" + quadObj(place({-6, 0, -4}), place({6, 0, -4}), place({6, 5, -4}), place({-6, 5, -4}));
    box("box", {-2, 0, -2}, {-0.75, 1.25, -0.5});
    box("slab", {0.5, 0.125, -1}, {2.5, 0.25, 0.5});
    box("step", {-0.5, 0, 0.5}, {0.25, 0.0625, 1.5});
    text += "o card\n" + quadObj(place({1, 0.5, -3}), place({2.5, 0.5, -3}), place({2.5, 2, -3}), place({1, 2, -3}));
    for (int i = 0; i < 6; ++i)
        box("wire", {-3.5 + i * 0.25, 0, -3.25}, {-3.5 + 1.0 / 128 + i * 0.25, 3, -3.25 + 1.0 / 128});
    text += "o sphere\n";
    const double r = 0.75;
    std::string sphere;
    for (int ring = 0; ring <= 16; ++ring)
        for (int s = 0; s < 32; ++s) {
            const double theta = std::acos(-1.0) * ring / 16, phi = 2 * std::acos(-1.0) * s / 32;
            // Rounded to 2^-20, so that moving the scene by whole numbers moves it exactly.
            const auto round = [](double x) { return std::round(x * 1048576) / 1048576; };
            sphere += vertex(place({1.75 + round(r * std::sin(theta) * std::cos(phi)), 1 + round(r * std::cos(theta)),
                -1.5 - round(r * std::sin(theta) * std::sin(phi))}));
        }
    for (int ring = 0; ring < 16; ++ring)
        for (int s = 0; s < 32; ++s) {
            const auto index = [&](int q, int side) { return q * 32 + side % 32 - 17 * 32; };
            sphere += fmt::format(
                "f {} {} {} {}\n", index(ring, s), index(ring + 1, s), index(ring + 1, s + 1), index(ring, s + 1));
        }
    return text + sphere;
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "limn-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
}
TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

RunResult runLimn(const std::string& arguments, const std::filesystem::path& folder, const std::string& environment) {
    const TemporaryFolder output;
    const auto out = output.path() / "out", err = output.path() / "err";
    const std::string command = fmt::format("cd '{}' && {} LIMN_GL_DEBUG=1 timeout 300 '{}' {} >'{}' 2>'{}' </dev/null",
        folder.string(), environment, LIMN_PROGRAM, arguments, out.string(), err.string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readFile(out), readFile(err)};
}

}  // namespace limn::test
