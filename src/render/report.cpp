#include "render/report.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

const Pass& passOf(const Pipeline& pipeline, const PlannedPass& planned) {
    return pipeline.graph.passes[static_cast<std::size_t>(planned.pass)];
}

/// Slots whose passes run in some samples, but not in the view's.
std::vector<std::string> restingSlots(const Pipeline& pipeline, const View& view) {
    std::vector<std::string> slots;
    for (const auto& planned : pipeline.plan.passes) {
        const Pass& pass = passOf(pipeline, planned);
        const bool rests = findSlot(pass.slot) && pass.slot != "geometry" && !view.runs(pass.rate);
        if (rests && std::find(slots.begin(), slots.end(), pass.slot) == slots.end()) slots.push_back(pass.slot);
    }
    return slots;
}

/// What the cheapest samples leave out, in words; empty if nothing.
std::string savedSamples(const Pipeline& pipeline, View view) {
    std::vector<std::string> most;
    int count = 0, one = 0;
    for (view.sample = 0; view.sample < view.sampling.samples(); ++view.sample) {
        const auto slots = restingSlots(pipeline, view);
        if (slots.size() > most.size()) {
            most = slots;
            count = 0;
            one = view.sample;
        }
        count += !slots.empty() && slots.size() == most.size();
    }
    if (most.empty()) return {};
    view.sample = one;
    const Plan narrow = pipeline.ofSample(view);
    std::string spared;
    int halo = 0, fullHalo = 0;
    for (std::size_t i = 0; i < narrow.passes.size(); ++i) {
        const Pass& pass = passOf(pipeline, narrow.passes[i]);
        if (pass.rate != kEverySample) continue;
        halo = std::max(halo, narrow.passes[i].halo);
        fullHalo = std::max(fullHalo, pipeline.plan.passes[i].halo);
        for (std::size_t w = 0; w < pass.writes.size(); ++w)
            if (pipeline.plan.passes[i].writes[w] && !narrow.passes[i].writes[w])
                spared += (spared.empty() ? "" : ", ")
                    + pipeline.graph.resources[static_cast<std::size_t>(pass.writes[w].resource.index)].name;
    }
    if (spared.empty() && halo == fullHalo) return {};
    return fmt::format("{} of {} samples run nothing of {}: {}{} pixels around the picture instead of {}", count,
        view.sampling.samples(), joinOr(most), spared.empty() ? "" : spared + " not made, ", halo, fullHalo);
}

void add(PlanFacts& facts, std::string name, std::string value) {
    facts.emplace_back(std::move(name), std::move(value));
}

void addPicture(PlanFacts& facts, const RenderConfig& config, const SceneAt& scene, const TilePipelines& pipelines) {
    add(facts, "picture",
        fmt::format("{}×{} pixels, camera '{}'", config.image.size.x, config.image.size.y, scene.camera.name));
    const Sampling& sampling = pipelines.sampling;
    add(facts, "samples",
        fmt::format("{} per pixel: {} sub-frame{} on a raster {}× finer", sampling.samples(), sampling.subFrames,
            sampling.subFrames == 1 ? "" : "s", sampling.raster));
    if (const std::string saved = savedSamples(pipelines.averaged, pipelines.averagedView); !saved.empty())
        add(facts, "spared", saved);
    if (const glm::ivec2 block = largestBlock(config.image.size); block != config.image.size)
        add(facts, "blocks",
            fmt::format("of up to {}×{} pixels, in tiles of up to {} each way", block.x, block.y,
                std::min(chooseTileSize(config, pipelines, block), largestBlockSide(config.image.size))));
    if (pipelines.guard > 0)
        add(facts, "guard band", fmt::format("{} pixels drawn around the picture", pipelines.guard));
}

void addScene(PlanFacts& facts, const RenderConfig& config, const LoadedScene& loaded, const SceneAt& scene) {
    for (const auto& choice : config.in("geometry"))
        add(facts, std::string(findSlot("geometry")->key), std::string(choice.technique->name));
    std::size_t faces = 0;
    for (const auto& instance : scene.instances)
        faces += scene.meshes[static_cast<std::size_t>(instance.mesh)]->poly.faceCount();
    add(facts, "objects",
        fmt::format("{} instances, {} faces, {} lights", scene.instances.size(), faces, scene.lights.size()));
    add(facts, "diagonal",
        fmt::format("{} scene units at frame {}", numberText(static_cast<float>(scene.info.diagonal())),
            loaded.scene.firstFrame()));
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (!scene.meshes[i]) continue;
        const MeshSource& source = loaded.scene.meshes[i];
        const PolyMesh& poly = scene.meshes[i]->poly;
        const auto options = subdivisionOf(source, poly);
        if (!options || poly.faceCount() == 0) continue;
        add(facts, "subdivision",
            fmt::format("'{}': {}", source.name,
                describe(*options, source.subdivision.edgeLength, planSubdivision(poly, *options))));
    }
}

/// Lengths of a technique that are relative to the scene.
void addLengths(PlanFacts& facts, const TechniqueChoice& choice, const SceneAt& scene) {
    const auto params = choice.at(scene.frame);
    for (const auto& field : choice.technique->schema) {
        if (&field.type() != &fieldType<Length>()) continue;
        const auto& length = *static_cast<const Length*>(field.constMember(params.get()));
        if (length.relative)
            add(facts, std::string(field.name),
                fmt::format("{}% of the diagonal = {} scene units ({} '{}')", numberText(length.amount * 100),
                    numberText(static_cast<float>(length.inSceneUnits(scene.info.diagonal()))), choice.technique->slot,
                    choice.technique->name));
    }
}

}  // namespace

PlanReport reportPlan(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize) {
    const SceneAt scene = sceneAt(loaded, frameRequest(config, frame));
    const PixelRect block{glm::ivec2(0), largestBlock(config.image.size)};
    TilePipelines pipelines =
        buildPipelines(config, scene, sceneFacts(scene), frame, maxTextureSize, 0, {block, block});
    PlanReport report;
    add(report.facts, "config", config.file.string());
    add(report.facts, "scene", loaded.scene.file);
    addPicture(report.facts, config, scene, pipelines);
    addScene(report.facts, config, loaded, scene);
    for (const auto& slot : allSlots())
        for (const auto& choice : config.in(slot.name)) addLengths(report.facts, choice, scene);
    if (config.output.isVector())
        for (const auto& choice : config.in("edges"))
            if (choice.technique->vectorLines)
                add(report.facts, "vectors",
                    fmt::format("the lines of '{}', from triangles and their edges on the CPU: no pass draws them",
                        choice.technique->name));
    if (pipelines.centre)
        add(report.facts, "data AOVs",
            fmt::format("taken at pixel centres by one more sub-frame: {}", passNames(*pipelines.centre)));
    report.pipeline = std::move(pipelines.averaged);
    report.centre = std::move(pipelines.centre);
    return report;
}

}  // namespace limn
