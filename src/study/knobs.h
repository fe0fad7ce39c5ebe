// What a study may turn: every setting of a config that buys accuracy with time, found through the parameter tables.
#pragma once

#include "render/config.h"
#include "stage/loaded_scene.h"

#include <map>
#include <string>
#include <vector>

namespace limn {

/// KEY → VALUE in TOML, over a config. The key of a slot replaces its whole table, and is applied before keys within.
/// Keys that begin with "scene." change the scene: "scene.subdivision.level" adds to the level of every cage,
/// "scene.shadow.resolution" multiplies that of every light.
using Settings = std::map<std::string, std::string>;

/// "ao.rays=8 image.samples=4"; "as it is" for none.
std::string settingsText(const Settings& settings);

/// A setting and the values that a study tries, from cheap to dear; the current one is among them.
struct Knob {
    std::string key;
    std::vector<std::string> values;
    std::size_t current = 0;
};

/// A config with settings applied, and the scene where they change it.
struct Variant {
    Node document;
    RenderConfig config;
    std::shared_ptr<const LoadedScene> scene;
};

class StudyConfig {
public:
    /// `document`: of a render config at `path`; `scene` must outlive it. `meshFile`: where the scene is a mesh file.
    StudyConfig(
        Node document, std::filesystem::path path, const LoadedScene& scene, const MeshFileOptions& meshFile = {});

    /// Throws what reading a config throws.
    Variant at(const Settings& settings) const;

    /// The knobs of what would run with these settings: those that change the plan, or the meshes of cages.
    std::vector<Knob> knobs(const Settings& settings, int frame) const;

    /// Techniques that find the same as the config's, with and without its filter: settings that replace [ao].
    std::vector<Settings> alternatives() const;
    /// The same settings with each filter, where they draw ambient occlusion.
    std::vector<Settings> otherFilters(const Settings& settings) const;
    /// The settings with which [ao] is ray traced as the config's technique would have it; nullopt where that has no
    /// radius, and so finds something else.
    std::optional<Settings> tracedOcclusion(int rays) const;

    /// What to write into the config for these settings: TOML, with comments for what belongs into the scene.
    std::string lines(const Settings& settings) const;

    const LoadedScene& scene() const { return scene_; }

private:
    Node document_;
    std::filesystem::path path_;
    MeshFileOptions meshFile_;
    const LoadedScene& scene_;
};

}  // namespace limn
