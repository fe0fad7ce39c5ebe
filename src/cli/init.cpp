// limn init: a commented scene and config to start from.

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "formats/format.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::cli {
namespace {

/// The fewest digits that place a point to within `precision`, however far from the origin it lies.
std::string vectorText(const glm::dvec3& v, double precision) {
    const double steps = std::pow(10.0, std::ceil(-std::log10(precision)));
    const auto digits = [&](double value) { return numberText(std::round(value * steps) / steps + 0.0); };
    return fmt::format("[{}, {}, {}]", digits(v.x), digits(v.y), digits(v.z));
}

/// A commented scene of one mesh file.
std::string sceneText(const SceneAt& scene, const std::string& name, const std::string& file) {
    std::string materials;
    for (const auto& material : scene.meshes.front()->poly.materialNames)
        if (!material.empty())
            materials += fmt::format(
                "#\n# [[material]]              # replaces the material of that name\n# name = {}\n# color = "
                "\"#d89c7a\"\n# shininess = 40           # a highlight; none at 1 or below\n",
                jsonText(material));
    const auto& light = scene.lights.front();
    const double precision = 1e-5 * glm::distance(scene.camera.position, scene.camera.lookAt);
    return fmt::format(R"(# A scene: what there is to draw. Every key: limn techniques --format markdown
version = 1
up = "{6}"                     # or "{7}"

[[mesh]]
name = {0}
file = {1}

# Without an [[instance]] each mesh is drawn once where it was modelled.
# [[instance]]
# mesh = {0}
# translate = [0, 0, 0]
# rotate = [0, 30, 0]        # degrees, about x, then y, then z
# scale = [1, 1, 1]

# A turntable: these lines, and in the camera below  orbit = {{ keys = [[1, 0], [121, 360]] }}. The config's output.path
# then needs #### for the number of the frame. More about it:
# limn techniques frames
# [animation]
# frames = "1-120"

[[camera]]                   # frames everything; move it as you like
name = "main"
position = {2}
look_at = {3}
focal_length = 50            # mm on a sensor 36 mm wide; or fov = 40; or orthographic_height = 3

[[light]]
kind = "sun"                 # sun, point or spot
direction = {4}
color = "#ffffff"
intensity = 1
shadow = {{ resolution = 2048 }}    # without this line: no shadow, no cost
{5})",
        jsonText(name), jsonText(file), vectorText(scene.camera.position, precision),
        vectorText(scene.camera.lookAt, precision), vectorText(light.direction, 1e-6), materials,
        scene.info.up.z > 0 ? "z" : "y", scene.info.up.z > 0 ? "y" : "z");
}

/// A commented config beside it.
std::string configText(const std::string& config, const std::string& name) {
    return fmt::format(
        R"(# A picture: how to draw the scene. A table that is not there is an effect that costs nothing.
version = 1
# See what will run with:  limn plan {0}
scene = "scene.toml"
camera = "main"

{1}
[output]
path = {2}                   # .png .jpg .tif, or .exr with every AOV in one file
aovs = ["beauty"]            # also: shade albedo ambient_occlusion edges normal depth object_id ...
)",
        shellText(config), quickstartStyle(), jsonText(name + ".png"));
}

ExitCode run(const std::string& model, const std::string& folderText, const MeshFileOptions& options) {
    const std::filesystem::path folder = folderText;
    if (!isMeshFile(model))
        throw Error(ExitCode::usage, {model}, "is no mesh file",
            "name an OBJ file; for a scene that exists, write a config that begins with scene = \"FILE\"");
    const LoadedScene loaded = loadScene(model, options);
    const SceneAt scene = sceneAt(loaded, {.sections = {}});
    const std::string name = std::filesystem::path(model).stem().string();
    // A config of a model called "scene" must not take the scene's name.
    const auto scenePath = folder / "scene.toml",
               configPath = folder / (name == "scene" ? "picture.toml" : name + ".toml");
    for (const auto& path : {scenePath, configPath})
        if (std::filesystem::exists(path))
            throw Error(ExitCode::cannotCreate, {path.string()}, "exists already",
                "choose another folder with --output, or move the file away");

    std::error_code ignored;
    const auto relative =
        std::filesystem::relative(std::filesystem::absolute(model), std::filesystem::absolute(folder), ignored);
    replaceFile(scenePath,
        sceneText(scene, name, relative.empty() ? std::filesystem::absolute(model).string() : relative.string()));
    replaceFile(configPath, configText(configPath.string(), name));
    log::info("Saved: '{}'", scenePath.string());
    log::info("Saved: '{}'", configPath.string());
    log::info("draw it with:  limn render {}", shellText(configPath.string()));
    return ExitCode::done;
}

}  // namespace

void addInit(CLI::App& app, Chosen& chosen) {
    auto model = std::make_shared<std::string>();
    auto folder = std::make_shared<std::string>(".");
    auto options = std::make_shared<MeshFileOptions>();
    auto* command = app.add_subcommand("init", "Write a commented scene and config to start from");
    command->add_option("MODEL", *model, "OBJ file")->required();
    command->add_option("--output", *folder, "Folder to write to")->type_name("DIR");
    addUpOption(*command, *options);
    command->callback([=, &chosen] { chosen = [=] { return run(*model, *folder, *options); }; });
}

}  // namespace limn::cli
