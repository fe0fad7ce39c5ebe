// What an effect is made of, and where it makes itself known.
//
// An effect is two files of one stem: src/effects/<slot>/<name>.cpp and shaders/effects/<slot>/<name>.comp. The .cpp
// ends with
//     const Technique kName{"slot", "name", "what it is", kParams, build};
// and nothing else knows that it exists. Its code lives in a namespace of its own, limn::<slot>_<name>, not in an
// anonymous one: g++ 12 merges the accessors of members of one name in anonymous structs of one name, across files.
#pragma once

#include "base/params.h"
#include "frame/aov.h"
#include "frame/gpu_scene.h"
#include "frame/view.h"
#include "graph/graph.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

/// Facts about the scene at a frame that an effect may build on.
struct SceneFacts {
    SceneInfo info;
    std::span<const Light> lights;
    std::span<const DrawInstance> instances;
    std::span<const Material> materials;
    bool textured = false;      ///< some drawn material has a texture
    bool cutouts = false;       ///< some drawn material has holes
    bool vertexColors = false;  ///< some drawn mesh has vertex colours, and a material that wants them
    bool shiny = false;         ///< some drawn material has a highlight
    bool coloredLight = false;  ///< some light is not grey
    bool lineRecords = false;   ///< some object or material says something about its lines
    bool sections = false;      ///< something is cut open
    bool hatched = false;       ///< and its cut faces are hatched
    int triangleBits = 0;       ///< of a number that names an instance and its triangle, where 32 bits can; else 0
};

struct TechniqueChoice;

/// What an effect builds its passes with.
class EffectBuilder {
public:
    EffectBuilder(Graph& graph, const View& view, const SceneFacts& scene)
        : graph_(graph), view_(view), scene_(scene) {}

    const View& view() const { return view_; }
    const SceneFacts& scene() const { return scene_; }

    /// The image that holds an AOV so far. Missing is a bug of the pipeline or of the order of slots: throws Error
    /// (internal).
    ResourceId read(const Aov& aov) const;
    std::optional<ResourceId> find(const Aov& aov) const;
    /// From now on this image is the AOV.
    void publish(const Aov& aov, ResourceId image) { published_[aov.name] = image; }

    /// An image as large as the region drawn, or of every second pixel of it each way (coarseness 2).
    ResourceId image(std::string name, Format format, int coarseness = 1);
    /// An image on the fine raster, for passes that run once per sub-frame.
    ResourceId fineImage(std::string name, Format format);
    bool usesFineRaster() const { return usesFineRaster_; }
    ResourceId image(const Aov& aov) { return image(std::string(aov.name), aov.format); }

    /// Adds a pass; slot, technique and (unless given) shader are filled in.
    void add(Pass pass);

    /// What a config says of techniques: for those that stand in two slots at once.
    void setChoices(std::vector<const TechniqueChoice*> choices) { choices_ = std::move(choices); }
    /// The choice of a technique in a slot, if it is there.
    const TechniqueChoice* chosen(std::string_view slot, std::string_view technique) const;

    /// The shadow maps of all lights that cast one, as one image; nullopt when none does.
    std::optional<ResourceId> shadowMaps();

    /// Lets the pass's shaders see the holes that materials cut (CUTOUTS), where there are any.
    void cutHoles(Pass& pass) const;
    /// Tells the pass's shaders how the visibility buffer names triangles.
    void defineSeen(Pass& pass) const;

    /// `rate`: of its passes that do not say.
    void beginTechnique(std::string slot, std::string technique, Pass::Rate rate = Pass::Rate::sample) {
        slot_ = std::move(slot), technique_ = std::move(technique), rate_ = rate;
    }
    /// For techniques of slots that do with a part of the samples, if they are sharp.
    void useEverySample() { rate_ = Pass::Rate::sample; }
    /// A unique suffix for layered slots ("edges" twice), or "".
    void setLayer(int layer) { layer_ = layer; }
    std::string layerSuffix() const { return layer_ > 0 ? "_" + std::to_string(layer_ + 1) : ""; }

private:
    Graph& graph_;
    const View& view_;
    const SceneFacts& scene_;
    std::map<std::string_view, ResourceId> published_;
    std::optional<ResourceId> shadowMaps_;
    std::vector<const TechniqueChoice*> choices_;
    std::string slot_, technique_;
    Pass::Rate rate_ = Pass::Rate::sample;
    int layer_ = 0;
    bool usesFineRaster_ = false;
};

/// The uniform block `params` of a pass, from a constants struct and its table.
template <class C, std::size_t N>
UniformBlock paramsBlock(const Field (&fields)[N], const C& constants) {
    return makeUniformBlock("params", 1, fields, &constants);
}

/// Settings that belong together. `mode = "paper"` is the preset of that name.
struct Preset {
    std::string_view name, doc;
    std::string_view settings;  ///< TOML: "kernel = 'sphere', dead_zone = 5"
};

/// Settings of a technique that has none.
struct NoParams {};

struct Technique {
    std::string_view slot, name, doc;
    Schema schema;
    std::vector<Preset> presets;
    std::shared_ptr<void> (*makeParams)();
    std::shared_ptr<void> (*copyParams)(const void*);
    void (*build)(EffectBuilder&, const void* params, const Technique& self);

    template <class P>
    Technique(std::string_view slot_, std::string_view name_, std::string_view doc_,
        std::type_identity_t<Schema> fields, void (*build_)(EffectBuilder&, const P&),
        std::vector<Preset> presets_ = {})
        : Technique(slot_, name_, doc_, fields, std::move(presets_)) {
        makeParams = []() -> std::shared_ptr<void> { return std::make_shared<P>(); };
        copyParams = [](const void* params) -> std::shared_ptr<void> {
            return std::make_shared<P>(*static_cast<const P*>(params));
        };
        buildFunction_ = reinterpret_cast<void (*)()>(build_);
        build = [](EffectBuilder& builder, const void* params, const Technique& self) {
            reinterpret_cast<void (*)(EffectBuilder&, const P&)>(self.buildFunction_)(
                builder, *static_cast<const P*>(params));
        };
    }

    Technique(const Technique&) = delete;
    Technique& operator=(const Technique&) = delete;

private:
    Technique(std::string_view slot_, std::string_view name_, std::string_view doc_, Schema schema_,
        std::vector<Preset>&& presets_);  // registers
    void (*buildFunction_)() = nullptr;
};

/// Every technique, by slot and name.
const std::vector<const Technique*>& allTechniques();
const Technique* findTechnique(std::string_view slot, std::string_view name);

/// A technique with its settings, as a config chose it.
struct TechniqueChoice {
    const Technique* technique = nullptr;
    std::shared_ptr<void> params;
    std::vector<Track> tracks;
    std::string mode = "default";

    /// The settings at a frame.
    std::shared_ptr<void> at(double frame) const;
};

/// A technique as it is when nothing is said but its name. Throws Error (internal) if there is none.
TechniqueChoice defaultChoice(std::string_view slot, std::string_view name);
/// Reads `technique`, `mode`, `preset` and the parameters of a section. Problems go to `errors`; `fallback` names the
/// technique when the section does not (empty: it must). `alsoKnown` are keys that somebody else reads.
TechniqueChoice readChoice(const Node& section, std::string_view slot, std::string_view fallback, std::string_view what,
    ErrorCollector& errors, std::span<const std::string_view> alsoKnown = {});

/// A setting of a choice changed from TOML text, as tests and studies do. Throws Errors.
void applySettings(TechniqueChoice& choice, std::string_view settings);

}  // namespace limn
