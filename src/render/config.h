// A render config, read and checked.
#pragma once

#include "effects/technique.h"
#include "image/image.h"

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace limn {

/// The techniques in each slot, by the slot's name; empty slots are left out.
using Choices = std::map<std::string, std::vector<TechniqueChoice>, std::less<>>;

struct ImageSettings {
    glm::ivec2 size{1280, 720};
    int samples = 8;
    int aoSamples = 0, lineSamples = 0;
    unsigned seed = 0;
    bool seedIsFrame = false, seedIsSurface = false;
    Color background{1, 1, 1};
    bool transparent = false;
    double dpi = 96;
    double shutter = 0;  ///< frames that the shutter is open for, around the frame's own time; 0: nothing blurs
    double guard = 0.05;
    int tile = 0;
};

/// What the picture is to keep; 0: no such promise. One of the two.
struct QualitySettings {
    double error = 0;    ///< of ambient occlusion, root mean square
    double seconds = 0;  ///< of drawing a frame
    bool isAsked() const { return error > 0 || seconds > 0; }
};

struct OutputSettings {
    std::filesystem::path path;   ///< #### is the frame number
    std::filesystem::path video;  ///< a film of all frames; empty: none
    std::vector<const Aov*> aovs{&aov::beauty};
    EncodeOptions encode;

    /// Are lines from the mesh drawn as lines into the file, and not into the picture?
    bool isVector() const;
};

struct RenderConfig {
    std::filesystem::path file;   ///< what it was read from
    std::filesystem::path scene;  ///< scene file, or an OBJ
    std::string camera;           ///< empty: the scene's first
    MeshFileOptions meshFile;     ///< where the scene is a mesh file
    ImageSettings image;
    QualitySettings quality;
    std::string promise;  ///< what its settings were chosen for; empty: nothing
    Choices choices;
    std::vector<std::string> sections;  ///< names of the scene's sections to cut by
    double scale = 0;                   ///< of a drawing on a sheet, for example 1/50; 0: from the camera
    std::optional<FrameRange> frames;   ///< replaces the scene's
    OutputSettings output;
    std::string hash;  ///< of everything in the config that its files show, includes and settings applied

    /// The techniques in a slot, in their order.
    const std::vector<TechniqueChoice>& in(std::string_view slot) const;
};

/// The tables that choose no technique, for the parameter reference.
std::vector<SettingsTable> configTables();

/// Settings of the command line, over a config.
struct ConfigOverrides {
    std::vector<std::string> settings;  ///< KEY=VALUE
    std::string camera;
    MeshFileOptions meshFile;  ///< where the scene is a mesh file
};

/// Layers settings (KEY=VALUE) onto a config's document, as --set does: settings of another technique than the one that
/// they choose are left out, with a warning. Throws Error (usage).
void layerSettings(Node& document, std::span<const std::string> settings);
/// A config's document; of a mesh file the quickstart's style, with the file as its scene. Throws Error.
Node readConfigDocument(const std::filesystem::path& path);
/// Reads a config, or draws an OBJ file in the quickstart's style. Throws every problem at once (Errors).
RenderConfig readRenderConfig(const std::filesystem::path& path, const ConfigOverrides& overrides = {});
RenderConfig parseRenderConfig(Node document, const std::filesystem::path& path, const ConfigOverrides& overrides = {});

/// The choices of a config's document for the slots. Problems go to `errors`.
Choices readChoices(const Node& document, ErrorCollector& errors);

/// The config's request for its scene at a frame.
FrameRequest frameRequest(const RenderConfig& config, double frame);

/// The style of a bare OBJ, as TOML.
std::string_view quickstartStyle();

}  // namespace limn
