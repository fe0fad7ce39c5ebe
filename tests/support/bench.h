// A whole pipeline for tests: a config and a scene from text, OBJ meshes from text, pictures in memory. Everything is
// the real thing.
#pragma once

#include "render/renderer.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace limn::test {

/// One device and renderer for the whole process, with GL debug messages collected.
Renderer& renderer();

/// A scene from TOML, whose meshes' files are given by name: {"plane.obj", "v 0 0 0 …"}.
LoadedScene makeScene(const std::string& toml, const std::vector<std::pair<std::string, std::string>>& files);
/// A config from TOML; the scene that it names is not opened.
RenderConfig makeConfig(const std::string& toml);

struct Picture {
    RenderedFrame frame;
    const Image& aov(const std::string& name) const;
};
/// Draws, and fails the test on any GL message or non-finite value. To see whether a comparison of pictures would
/// notice anything, LIMN_TEST_ONE_SIDE = "lens 2" draws the process's second picture through a lens 2 % longer, and
/// "values 2" makes its values 2 % larger: tests/gl/one_side_test.cpp.
Picture draw(const RenderConfig& config, const LoadedScene& scene, const RenderOptions& options = {}, int frame = 1);

// Meshes as OBJ text.
std::string quadObj(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);
/// Centred on the origin, with `sides` segments around and half as many from pole to pole.
std::string sphereObj(double radius, int sides);
std::string boxObj(const glm::dvec3& lo, const glm::dvec3& hi);
/// A little of everything: floor, walls, boxes, a sphere, a thin card and wires, near and far.
std::string mixedObj(const glm::dvec3& offset = glm::dvec3(0), double scale = 1);

/// A [[camera]]; `lens` is its line of fov, focal_length or orthographic_height.
std::string cameraToml(
    const glm::dvec3& position, const glm::dvec3& lookAt, const std::string& lens, const glm::dvec3& up = {0, 1, 0});

/// Numbers in full, as TOML: "[1, 2, 3]".
std::string toml(const glm::dvec3& v);

/// A folder of its own for one test, gone when the test ends.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// What a run of the program did.
struct RunResult {
    int exitCode = 0;
    std::string out, err;
};
/// Runs the built limn through the shell, in `folder`, with `environment` ("A=1 B=2") before it.
RunResult runLimn(
    const std::string& arguments, const std::filesystem::path& folder = ".", const std::string& environment = "");

}  // namespace limn::test
