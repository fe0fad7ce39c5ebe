#include "render/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// The sum of an AOV over the samples of each pixel. The AOV's own pass sums it up where nothing else reads it; else
/// another pass does. Returns the sum and its number of samples.
std::pair<ResourceId, int> sumOf(Graph& graph, EffectBuilder& builder, const Aov& aov, const View& view) {
    const ResourceId image = builder.read(aov);
    const Format format = info(aov.format).channels == 1 ? Format::r32f : Format::rgba32f;
    const auto note = [](int samples) { return fmt::format("sum of {} samples", samples); };
    const auto reads = [&](const Pass& pass) {
        return std::any_of(
            pass.reads.begin(), pass.reads.end(), [&](const Read& read) { return read.resource == image; });
    };
    const bool isRead = std::any_of(graph.passes.begin(), graph.passes.end(), reads);
    int rate = kEverySample;
    for (Pass& pass : graph.passes)
        for (Write& write : pass.writes) {
            if (write.resource != image) continue;
            rate = pass.rate;
            if (isRead || pass.kind != Pass::Kind::compute || pass.mask >= 0) continue;
            Resource& made = graph.resources[static_cast<std::size_t>(image.index)];
            write.sums = true;
            made.persistent = true;
            made.format = format;
            pass.note += (pass.note.empty() ? "" : ", ") + note(view.sampling.count(rate));
            return {image, view.sampling.count(rate)};
        }
    const ResourceId sum = graph.add({fmt::format("{}_sum", aov.name), format, view.region.size, true});
    Pass pass;
    pass.name = fmt::format("accumulate_{}", aov.name);
    pass.shader = "gpu/accumulate";
    pass.reads = {{"source", image}};
    pass.writes = {{"sum", sum, SceneData::none, glm::vec4(0), true}};
    pass.note = note(view.sampling.count(rate));
    builder.beginPasses("samples", "accumulate", rate);
    builder.add(std::move(pass));
    return {sum, view.sampling.count(rate)};
}

/// Adds the passes of all slots' techniques, in order.
void fillSlots(const RenderConfig& config, EffectBuilder& builder, Graph& graph, double frame) {
    std::vector<const TechniqueChoice*> all;
    for (const auto& slot : allSlots())
        for (const auto& choice : config.in(slot.name)) all.push_back(&choice);
    builder.setChoices(std::move(all));
    for (const auto& slot : allSlots()) {
        const auto& choices = config.in(slot.name);
        if (choices.empty() && (slot.parent().empty() || !config.in(slot.parent()).empty()))
            graph.absent.emplace_back(slot.name);
        if (!choices.empty() && slot.worksOn && !builder.find(*slot.worksOn))
            throw Error(ExitCode::usage, {config.file.string()},
                fmt::format(
                    "the {} has nothing to work on: '{}' is part of another image", slot.label(), slot.worksOn->name),
                fmt::format("leave the {} out, or use another technique in one of the sections", slot.ownKey()));
        for (std::size_t i = 0; i < choices.size(); ++i) {
            const Technique& technique = *choices[i].technique;
            builder.beginTechnique(slot, technique.name, static_cast<int>(i));
            technique.build(builder, choices[i].at(frame).get(), technique);
        }
    }
}

[[noreturn]] void failUnmade(const EffectBuilder& builder, const Aov& aov, double frame) {
    std::string remedy = "raise the opacity of a line layer, or leave the AOV out";
    if (!aov.onlyBy.empty())
        remedy = fmt::format("only the technique \"{}\" makes it", aov.onlyBy);
    else if (builder.find(aov::depthTangent))
        remedy = "ask for depth_tangent: ambient occlusion and lines are one image";
    throw Error(ExitCode::usage, {},
        fmt::format("the AOV '{}' is asked for, but at frame {} nothing makes it", aov.name, frame), remedy);
}

Pipeline buildUnplaced(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame) {
    Pipeline result;
    result.graph.samples = view.sampling.samples();
    EffectBuilder builder(result.graph, view, facts);
    builder.setBackground({config.image.background, config.image.transparent});
    builder.setKeepsVectors(config.output.isVector());
    fillSlots(config, builder, result.graph, frame);
    for (const Aov* aov : aovs) {
        if (!builder.find(*aov)) failUnmade(builder, *aov, frame);
        const bool sums = view.sampling.samples() > 1 && aov->isAveraged();
        const auto [image, summed] = sums ? sumOf(result.graph, builder, *aov, view) : std::pair(builder.read(*aov), 1);
        result.wanted.push_back({std::string(aov->name), image, view.keptGuard});
        result.aovs.push_back(aov);
        result.summed.push_back(summed);
    }
    result.usesFineRaster = builder.usesFineRaster();
    result.plan = compile(result.graph, result.wanted);
    return result;
}

const Pass& passOf(const Pipeline& pipeline, const PlannedPass& planned) {
    return pipeline.graph.passes[static_cast<std::size_t>(planned.pass)];
}

/// Bytes of a plan's images per pixel of the region drawn, without images as large as the canvas.
double bytesPerPixel(const Pipeline& pipeline, const View& view) {
    double bytes = 0;
    for (const auto& texture : pipeline.plan.textures)
        if (texture.size.x <= view.region.size.x) bytes += static_cast<double>(texture.bytes());
    return bytes / (static_cast<double>(view.region.size.x) * view.region.size.y);
}

}  // namespace

std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged) {
    std::vector<const Aov*> chosen;
    for (const Aov* aov : aovs)
        if (aov->isAveraged() == averaged) chosen.push_back(aov);
    return chosen;
}

Pipeline buildPipeline(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame) {
    try {
        return buildUnplaced(config, facts, view, aovs, frame);
    } catch (const Error& error) {  // techniques do not know their settings' file
        if (!error.where.file.empty() || error.code != ExitCode::usage) throw;
        throw Error(error.code, {config.file.string()}, error.problem, error.remedy);
    }
}

Plan Pipeline::ofSample(const View& view) const {
    return narrow(graph, plan, wanted, [&](const Pass& pass) { return view.runs(pass.rate); });
}

SceneData TilePipelines::sceneData() const {
    const SceneData all = averaged.plan.sceneData | forVectors;
    return centre ? all | centre->plan.sceneData : all;
}

ViewRequest viewRequest(
    const RenderConfig& config, const Sampling& sampling, int frame, int guard, int keptGuard, const Tile& tile) {
    ViewRequest request;
    request.imageSize = config.image.size;
    request.block = tile.block;
    request.tile = tile.rect;
    request.sampling = sampling;
    request.aoSamples = config.image.aoSamples;
    request.lineSamples = config.image.lineSamples;
    request.seed = config.image.seedIsFrame ? static_cast<unsigned>(frame) : config.image.seed;
    request.isBlurred = config.image.shutter > 0;
    request.noiseOnSurface = config.image.seedIsSurface;
    request.dpi = config.image.dpi;
    request.guard = guard;
    request.keptGuard = keptGuard;
    constexpr int kWidest = 512;  // the most that large pictures can afford around each block
    request.widestGuard = std::min(
        static_cast<int>(std::ceil(config.image.guard * std::max(config.image.size.x, config.image.size.y))), kWidest);
    return request;
}

TilePipelines buildPipelines(const RenderConfig& config, const SceneAt& scene, const SceneFacts& facts, int frame,
    int maxTextureSize, int keptGuard, const Tile& tile) {
    TilePipelines result;
    const auto averaged = chooseAovs(config.output.aovs, true), centre = chooseAovs(config.output.aovs, false);
    // Without anything to average, one sample at the pixel's centre is enough.
    const bool together = averaged.empty() || config.image.samples == 1;
    const std::span<const Aov* const> first = together ? config.output.aovs : averaged;
    const auto viewOf = [&](const Sampling& sampling) {
        return makeView(scene.camera, scene.info, viewRequest(config, sampling, frame, result.guard, keptGuard, tile));
    };
    const auto build = [&] {
        result.averagedView = viewOf(result.sampling);
        result.averaged = buildPipeline(config, facts, result.averagedView, first, frame);
        if (together || centre.empty()) return;
        result.centreView = viewOf({});
        result.centre = buildPipeline(config, facts, result.centreView, centre, frame);
    };
    if (!averaged.empty()) result.sampling = {1, config.image.samples};
    if (config.output.isVector()) result.forVectors = SceneData::triangles | SceneData::normals;
    if (config.output.isVector() && facts.cutouts) result.forVectors = result.forVectors | SceneData::uvs;
    // The first pipelines tell the guard band's width, and whether a finer raster is useful.
    build();
    result.guard = std::max(result.averaged.plan.halo(), result.centre ? result.centre->plan.halo() : 0);
    if (result.averaged.usesFineRaster && config.image.shutter == 0)  // else no two samples show the same triangles
        result.sampling =
            splitSamples(result.sampling.samples(), largestBlock(config.image.size) + 2 * result.guard, maxTextureSize);
    if (result.guard > 0 || result.sampling.raster > 1) build();
    return result;
}

std::string passNames(const Pipeline& pipeline) {
    std::string text;
    for (const auto& planned : pipeline.plan.passes) text += (text.empty() ? "" : " ") + passOf(pipeline, planned).name;
    return text;
}

bool looksEverywhere(const Pipeline& pipeline) {
    return std::any_of(
        pipeline.plan.passes.begin(), pipeline.plan.passes.end(), [](const auto& planned) { return planned.whole; });
}

bool takesAnyTile(const TilePipelines& pipelines) {
    const auto takes = [](const Pipeline& pipeline) {
        return !looksEverywhere(pipeline)
            && std::none_of(pipeline.plan.passes.begin(), pipeline.plan.passes.end(),
                [&](const auto& planned) { return passOf(pipeline, planned).isTiedToCanvas; });
    };
    return takes(pipelines.averaged) && (!pipelines.centre || takes(*pipelines.centre));
}

int chooseTileSize(const RenderConfig& config, const TilePipelines& pipelines, glm::ivec2 block) {
    const int whole = std::max(block.x, block.y);
    if (!takesAnyTile(pipelines)) return whole;
    if (config.image.tile > 0) return std::max(config.image.tile / 4 * 4, 16);
    constexpr double kBudget = 512.0 * 1024 * 1024;
    const double pixels = kBudget / std::max(bytesPerPixel(pipelines.averaged, pipelines.averagedView), 16.0);
    const glm::dvec2 around = block + 2 * pipelines.guard;
    if (around.x * around.y <= pixels) return whole;
    return std::clamp((static_cast<int>(std::sqrt(pixels)) - 2 * pipelines.guard) / 4 * 4, 256, std::max(whole, 256));
}

}  // namespace limn
