#include "render/frame_plans.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {

ViewRequest viewRequest(
    const RenderConfig& config, const SampleSplit& split, int frame, int guard, int keptGuard, const Tile& tile) {
    ViewRequest request;
    request.imageSize = config.image.size;
    request.block = tile.block;
    request.tile = tile.rect;
    request.split = split;
    request.aoSamples = config.image.aoSamples;
    request.lineSamples = config.image.lineSamples;
    request.seed = config.image.seedIsFrame ? static_cast<unsigned>(frame) : config.image.seed;
    request.dpi = config.image.dpi;
    request.guard = guard;
    request.keptGuard = keptGuard;
    constexpr int kWidest = 512;  // what large pictures can afford around each block
    request.widestGuard = std::min(
        static_cast<int>(std::ceil(config.image.guard * std::max(config.image.size.x, config.image.size.y))), kWidest);
    return request;
}

SceneData FramePlans::sceneData() const {
    return centre ? averaged.plan.sceneData | centre->plan.sceneData : averaged.plan.sceneData;
}

int largestBlockSide(glm::ivec2 size) { return std::max(size.x, size.y) <= 4096 ? 4096 : 2048; }

std::vector<std::pair<int, int>> spans(int length, int most) {
    const int count = (length + most - 1) / most;
    const int step = std::min((((length + count - 1) / count) + 3) / 4 * 4, std::max(most, 4));
    std::vector<std::pair<int, int>> result;
    for (int at = 0; at < length; at += step) result.emplace_back(at, std::min(at + step, length));
    return result;
}

glm::ivec2 largestBlock(glm::ivec2 size) {
    const auto first = [&](int length) { return spans(length, largestBlockSide(size)).front().second; };
    return {first(size.x), first(size.y)};
}

FramePlans planBoth(const RenderConfig& config, const DrawScene& scene, const SceneFacts& facts, int frame,
    int maxTextureSize, int keptGuard, const Tile& tile) {
    FramePlans plans;
    auto averaged = chooseAovs(config.output.aovs, true);
    const auto centre = chooseAovs(config.output.aovs, false);
    // Without anything to average one look at the pixel's centre is all there is to do.
    const bool together = averaged.empty() || config.image.samples == 1;
    const auto plan = [&] {
        plans.averagedView =
            makeView(scene.camera, scene.info, viewRequest(config, plans.split, frame, plans.guard, keptGuard, tile));
        plans.averaged = planFrame(config, facts, plans.averagedView,
            together ? std::span(config.output.aovs) : std::span<const Aov* const>(averaged), frame);
    };
    if (averaged.empty())
        plans.split = {};
    else
        plans.split = {1, config.image.samples};
    // The first plan tells how wide a guard band is needed, and whether a finer raster is of use.
    plan();
    plans.guard = plans.averaged.plan.halo();
    const auto makeCentre = [&] {
        if (together || centre.empty()) return;
        plans.centreView =
            makeView(scene.camera, scene.info, viewRequest(config, {}, frame, plans.guard, keptGuard, tile));
        plans.centre = planFrame(config, facts, plans.centreView, centre, frame);
    };
    makeCentre();
    if (plans.centre) plans.guard = std::max(plans.guard, plans.centre->plan.halo());
    if (plans.averaged.usesFineRaster)
        plans.split =
            splitSamples(plans.split.samples(), largestBlock(config.image.size) + 2 * plans.guard, maxTextureSize);
    if (plans.guard > 0 || plans.split.raster > 1) {
        plan();
        makeCentre();
    }
    return plans;
}

std::string planSummary(const FramePlan& frame) {
    std::string text;
    for (const auto& planned : frame.plan.passes)
        text += (text.empty() ? "" : " ") + frame.graph.passes[static_cast<std::size_t>(planned.pass)].name;
    return text;
}

namespace {

/// Bytes that a plan's images take per pixel of the region drawn; what is as large as the canvas left out.
double bytesPerPixel(const FramePlan& frame, const View& view) {
    double bytes = 0;
    for (const auto& texture : frame.plan.textures)
        if (texture.size.x <= view.region.size.x) bytes += static_cast<double>(texture.bytes());
    return bytes / (static_cast<double>(view.region.size.x) * view.region.size.y);
}

}  // namespace

bool looksEverywhere(const FramePlan& frame) {
    return std::any_of(
        frame.plan.passes.begin(), frame.plan.passes.end(), [](const auto& planned) { return planned.whole; });
}

int chooseTileSize(const RenderConfig& config, const FramePlans& plans, glm::ivec2 block) {
    const bool anySize = config.accuracy == Accuracy::exact && !looksEverywhere(plans.averaged)
        && !(plans.centre && looksEverywhere(*plans.centre));
    const int whole = std::max(block.x, block.y);
    if (!anySize) return whole;  // the hardware's interpolation is tied to the canvas
    if (config.image.tile > 0) return std::max(config.image.tile / 4 * 4, 16);
    constexpr double kBudget = 512.0 * 1024 * 1024;
    const double pixels = kBudget / std::max(bytesPerPixel(plans.averaged, plans.averagedView), 16.0);
    const glm::dvec2 around = block + 2 * plans.guard;
    if (around.x * around.y <= pixels) return whole;
    return std::clamp((static_cast<int>(std::sqrt(pixels)) - 2 * plans.guard) / 4 * 4, 256, std::max(whole, 256));
}

/// What samples save that do not find anew what others do, in words; empty where there are none, or nothing is saved.
static std::string savedSamples(const FramePlan& frame, View view) {
    const auto passOf = [&](const PlannedPass& planned) -> const Pass& {
        return frame.graph.passes[static_cast<std::size_t>(planned.pass)];
    };
    const auto runsSome = [&](Pass::Rate rate) {
        return std::any_of(frame.plan.passes.begin(), frame.plan.passes.end(),
            [&](const auto& planned) { return passOf(planned).rate == rate; });
    };
    const bool lines = runsSome(Pass::Rate::line), occlusion = runsSome(Pass::Rate::occlusion);
    int count = 0, one = 0;
    for (view.sample = 0; view.sample < view.split.samples(); ++view.sample)
        if (!(lines && view.findsLines()) && !(occlusion && view.findsOcclusion())) {
            one = view.sample;
            ++count;
        }
    if (count == 0 || !(lines || occlusion)) return {};
    view.sample = one;
    const Plan narrow = frame.ofSample(view);
    std::string spared;
    int halo = 0, fullHalo = 0;
    for (std::size_t i = 0; i < narrow.passes.size(); ++i) {
        const Pass& pass = passOf(narrow.passes[i]);
        if (pass.rate != Pass::Rate::sample) continue;
        halo = std::max(halo, narrow.passes[i].halo);
        fullHalo = std::max(fullHalo, frame.plan.passes[i].halo);
        for (std::size_t w = 0; w < pass.writes.size(); ++w)
            if (frame.plan.passes[i].writes[w] && !narrow.passes[i].writes[w])
                spared += (spared.empty() ? "" : ", ")
                    + frame.graph.resources[static_cast<std::size_t>(pass.writes[w].resource.index)].name;
    }
    if (spared.empty() && halo == fullHalo) return {};
    return fmt::format("{} of {} samples find {}: {}{} pixels around the picture instead of {}", count,
        view.split.samples(),
        lines && occlusion ? "neither lines nor occlusion"
            : lines        ? "no lines"
                           : "no occlusion",
        spared.empty() ? "" : spared + " not made, ", halo, fullHalo);
}

ExplainedPlan planConfig(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize) {
    const DrawScene scene = resolveFrame(loaded, frameRequest(config, frame));
    const SceneFacts facts = sceneFacts(scene);
    const PixelRect firstBlock{glm::ivec2(0), largestBlock(config.image.size)};
    FramePlans plans = planBoth(config, scene, facts, frame, maxTextureSize, 0, {firstBlock, firstBlock});
    const std::string saved = savedSamples(plans.averaged, plans.averagedView);
    ExplainedPlan result{std::move(plans.averaged), std::move(plans.centre), {}};

    const auto& split = plans.split;
    std::size_t faces = 0;
    for (const auto& instance : scene.instances)
        faces += loaded.meshes[static_cast<std::size_t>(instance.mesh)].poly.faceCount();
    const auto fact = [&](std::string name, std::string value) {
        result.facts.emplace_back(std::move(name), std::move(value));
    };
    fact("config", config.file.string());
    fact("scene", loaded.scene.file);
    fact("picture",
        fmt::format("{}×{} pixels, camera '{}'", config.image.size.x, config.image.size.y, scene.camera.name));
    fact("samples",
        fmt::format("{} per pixel: {} sub-frame{} on a raster {}× finer", split.samples(), split.subFrames,
            split.subFrames == 1 ? "" : "s", split.raster));
    if (!saved.empty()) fact("spared", saved);
    if (firstBlock.size != config.image.size)
        fact("blocks",
            fmt::format("of up to {}×{} pixels, in tiles of up to {} each way", firstBlock.size.x, firstBlock.size.y,
                std::min(chooseTileSize(config, plans, firstBlock.size), largestBlockSide(config.image.size))));
    if (plans.guard > 0) fact("guard band", fmt::format("{} pixels drawn around the picture", plans.guard));
    fact("accuracy", std::string(enumNames<Accuracy>[static_cast<std::size_t>(config.accuracy)]));
    fact("objects",
        fmt::format("{} instances, {} faces, {} lights", scene.instances.size(), faces, scene.lights.size()));
    fact("diagonal",
        fmt::format("{} scene units at frame {}", numberText(static_cast<float>(scene.info.diagonal())),
            loaded.scene.firstFrame()));
    const auto lengths = [&](const TechniqueChoice& choice) {
        const auto params = choice.at(frame);
        for (const auto& f : choice.technique->schema)
            if (&f.type() == &fieldType<Length>()) {
                const auto& length = *static_cast<const Length*>(f.member_(params.get()));
                if (length.relative)
                    fact(std::string(f.name),
                        fmt::format("{}% of the diagonal = {} scene units ({} '{}')", numberText(length.amount * 100),
                            numberText(static_cast<float>(length.inSceneUnits(scene.info.diagonal()))),
                            choice.technique->slot, choice.technique->name));
            }
    };
    for (std::size_t i = 0; i < loaded.meshes.size(); ++i) {
        auto options = subdivisionOf(loaded.scene.meshes[i], loaded.meshes[i].poly);
        if (!options || loaded.meshes[i].poly.faceCount() == 0) continue;
        fact("subdivision",
            fmt::format("'{}': {}", loaded.scene.meshes[i].name,
                describe(*options, loaded.scene.meshes[i].subdivision.edgeLength,
                    planSubdivision(loaded.meshes[i].poly, *options))));
    }
    if (config.ao) lengths(*config.ao);
    for (const auto& layer : config.edges) lengths(layer);
    if (result.centre)
        fact("data AOVs", fmt::format("taken at pixel centres by one more sub-frame: {}", planSummary(*result.centre)));
    return result;
}

}  // namespace limn
