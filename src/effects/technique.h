// The parts of an effect, and its registration.
//
// An effect is two files of one stem: src/effects/<slot>/<name>.cpp and shaders/effects/<slot>/<name>.comp. The .cpp
// ends with
//     const Technique kName{"slot", "name", "what it is", kParams, build};
// and no other file names it. Its code lives in a namespace of its own, limn::<slot>_<name>, not in an anonymous one:
// g++ 12 merges the accessors of members of one name in anonymous structs of one name, across files.
#pragma once

#include "drawing/drawing.h"
#include "effects/slot.h"
#include "graph/graph.h"
#include "picture/aov.h"
#include "picture/view.h"
#include "settings/fields.h"
#include "stage/facts.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

struct Technique;
struct TechniqueChoice;

/// The picture's colour where no object is.
struct Background {
    Color color{1, 1, 1};
    bool transparent = false;
};

/// The interface with which an effect builds its passes.
class EffectBuilder {
public:
    EffectBuilder(Graph& graph, const View& view, const SceneFacts& scene)
        : graph_(graph), view_(view), scene_(scene) {}

    const View& view() const { return view_; }
    const SceneFacts& scene() const { return scene_; }

    /// The image that holds an AOV so far. A missing one is a bug of the pipeline or of the order of slots: throws
    /// Error (internal).
    ResourceId read(const Aov& aov) const;
    std::optional<ResourceId> find(const Aov& aov) const;
    /// From now on this image is the AOV.
    void publish(const Aov& aov, ResourceId image) { published_[aov.name] = image; }

    /// An image as large as the region drawn, or with every second pixel each way (coarseness 2).
    ResourceId image(std::string name, Format format, int coarseness = 1);
    /// An image on the fine raster, for passes that run once per sub-frame.
    ResourceId fineImage(std::string name, Format format);
    bool usesFineRaster() const { return usesFineRaster_; }
    ResourceId image(const Aov& aov) { return image(std::string(aov.name), aov.format); }

    /// Adds a pass, and fills in slot, technique and (unless given) shader.
    void add(Pass pass);

    /// The config's choices for all slots.
    void setChoices(std::vector<const TechniqueChoice*> choices) { choices_ = std::move(choices); }
    /// The config's choice of this technique, or null. A technique of two slots uses it to find its other half.
    const TechniqueChoice* chosen(const Technique& technique) const;

    /// The colour behind everything.
    const Background& background() const { return background_; }
    void setBackground(const Background& background) { background_ = background; }

    /// Are lines that can be vectors left to the file?
    bool keepsVectors() const { return keepsVectors_; }
    void setKeepsVectors(bool keeps) { keepsVectors_ = keeps; }

    /// The shadow maps of all lights that cast one, as one image; nullopt when none does.
    std::optional<ResourceId> shadowMaps();

    /// Do vertices have one number for all attributes?
    bool isUnified() const;
    /// Gives the pass's shaders the holes of materials (CUTOUTS), if there are any.
    void cutHoles(Pass& pass) const;
    /// Tells the pass's shaders how the visibility buffer names triangles.
    void defineSeen(Pass& pass) const;

    /// Gives the pass's shaders what shaders/lib/random.glsl reads; call last of all that adds reads. Throws Error.
    void seedNoise(Pass& pass) const;

    /// Later passes belong to this technique, number `layer` of those in its slot.
    void beginTechnique(const Slot& slot, std::string_view technique, int layer = 0);
    /// Later passes belong to no slot's technique; `rate`: see picture/sampling.h.
    void beginPasses(std::string slot, std::string technique, int rate);
    /// Later passes of the technique run in every sample, whatever its slot's rate.
    void useEverySample() { rate_ = kEverySample; }
    /// A unique suffix for layered slots ("edges" twice), or "".
    std::string layerSuffix() const { return layer_ > 0 ? "_" + std::to_string(layer_ + 1) : ""; }

private:
    Graph& graph_;
    const View& view_;
    const SceneFacts& scene_;
    std::map<std::string_view, ResourceId> published_;
    std::optional<ResourceId> shadowMaps_;
    std::vector<const TechniqueChoice*> choices_;
    Background background_;
    std::string slot_, technique_;
    int rate_ = kEverySample;
    int layer_ = 0;
    bool usesFineRaster_ = false, keepsVectors_ = false;
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
    /// Of techniques whose lines can be vectors: the lines. They then build no pass where
    /// EffectBuilder::keepsVectors().
    LineLayer (*vectorLines)(const View&, const void* params) = nullptr;

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

    /// The same for a technique whose lines can be vectors.
    template <class P>
    Technique(std::string_view slot_, std::string_view name_, std::string_view doc_,
        std::type_identity_t<Schema> fields, void (*build_)(EffectBuilder&, const P&),
        LineLayer (*vectorLines_)(const View&, const void*), std::vector<Preset> presets_)
        : Technique(slot_, name_, doc_, fields, build_, std::move(presets_)) {
        vectorLines = vectorLines_;
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

    /// The settings at a frame.
    std::shared_ptr<void> at(double frame) const;
};

/// A technique with its default settings. Throws Error (internal) if there is none.
TechniqueChoice defaultChoice(std::string_view slot, std::string_view name);
/// Reads a slot's table: `technique`, `mode`, `preset` and the parameters, or the technique's name alone. Problems go
/// to `errors`; `alsoKnown` are keys that somebody else reads.
TechniqueChoice readChoice(const Node& table, const Slot& slot, std::string_view what, ErrorCollector& errors,
    std::span<const std::string_view> alsoKnown = {});

/// Changes settings of a choice from TOML text, for tests and studies. Throws Errors.
void applySettings(TechniqueChoice& choice, std::string_view settings);

}  // namespace limn
