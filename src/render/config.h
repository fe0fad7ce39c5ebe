// A render config: what a person asked for, read and checked.
#pragma once

#include "effects/technique.h"
#include "image/image.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace limn {

/// What fills each slot, by the slot's name; nothing where no technique does.
using Choices = std::map<std::string, std::vector<TechniqueChoice>, std::less<>>;

struct ImageSettings {
    glm::ivec2 size{1280, 720};
    int samples = 8;
    int aoSamples = 0, lineSamples = 0;
    unsigned seed = 0;
    bool seedIsFrame = false;
    Color background{1, 1, 1};
    bool transparent = false;
    double dpi = 96;
    double guard = 0.05;
    int tile = 0;
};

struct OutputSettings {
    std::filesystem::path path;  ///< #### is the frame number
    std::vector<const Aov*> aovs{&aov::beauty};
    EncodeOptions encode;
};

struct RenderConfig {
    std::filesystem::path file;   ///< what it was read from
    std::filesystem::path scene;  ///< scene file, or an OBJ
    std::string camera;           ///< empty: the scene's first
    MeshFileOptions meshFile;     ///< where the scene is a mesh file
    ImageSettings image;
    Choices choices;
    std::vector<std::string> sections;  ///< names of the scene's sections to cut by
    double scale = 0;                   ///< of a drawing on a sheet: 1/50 for example; 0: as the camera says
    std::optional<FrameRange> frames;   ///< replaces the scene's
    OutputSettings output;
    std::string hash;  ///< of everything in the config, includes and settings applied

    /// The techniques in a slot, in their order.
    const std::vector<TechniqueChoice>& in(std::string_view slot) const;
};

struct ConfigTable {
    std::string_view name, doc;
    Schema schema;
};
/// Those that choose no technique, for the parameter reference.
std::vector<ConfigTable> configTables();

/// What the command line adds to a config.
struct ConfigOverrides {
    std::vector<std::string> settings;  ///< KEY=VALUE
    std::string camera;
    MeshFileOptions meshFile;  ///< where the scene is a mesh file
};

/// Reads a config, or makes the quickstart's style around an OBJ file. Every problem at once (Errors).
RenderConfig readRenderConfig(const std::filesystem::path& path, const ConfigOverrides& overrides = {});
RenderConfig parseRenderConfig(Node document, const std::filesystem::path& path, const ConfigOverrides& overrides = {});

/// What a config's document chooses for the slots. Problems go to `errors`.
Choices readChoices(const Node& document, ErrorCollector& errors);

/// What the config wants of its scene at a frame.
FrameRequest frameRequest(const RenderConfig& config, double frame);

/// The style in which a bare OBJ is drawn, as TOML.
std::string_view quickstartStyle();

}  // namespace limn
