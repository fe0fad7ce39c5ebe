#include "render/pipeline.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

void build(EffectBuilder& builder, const TechniqueChoice& choice, double frame, Pass::Rate rate = Pass::Rate::sample) {
    builder.beginTechnique(std::string(choice.technique->slot), std::string(choice.technique->name), rate);
    choice.technique->build(builder, choice.at(frame).get(), *choice.technique);
}

/// The mean of an AOV over the samples of each pixel. Where nothing else reads the AOV, the pass that makes it adds it
/// up itself; else another one does.
ResourceId accumulate(Graph& graph, EffectBuilder& builder, const Aov& aov, const View& view) {
    const ResourceId image = builder.read(aov);
    const Format format = info(aov.format).channels == 1 ? Format::r32f : Format::rgba32f;
    const auto note = [&](Pass::Rate rate) { return fmt::format("mean of {} samples", view.samplesAt(rate)); };
    const auto reads = [&](const Pass& pass) {
        return std::any_of(
            pass.reads.begin(), pass.reads.end(), [&](const Read& read) { return read.resource == image; });
    };
    const bool isRead = std::any_of(graph.passes.begin(), graph.passes.end(), reads);
    Pass::Rate rate = Pass::Rate::sample;
    for (Pass& pass : graph.passes)
        for (Write& write : pass.writes) {
            if (write.resource != image) continue;
            rate = pass.rate;
            if (isRead || pass.kind != Pass::Kind::compute || pass.mask >= 0) continue;
            Resource& made = graph.resources[static_cast<std::size_t>(image.index)];
            write.mean = true;
            made.persistent = true;
            made.format = format;
            pass.note += (pass.note.empty() ? "" : ", ") + note(pass.rate);
            return image;
        }
    const ResourceId mean = graph.add({fmt::format("{}_mean", aov.name), format, view.region.size, true});
    Pass pass;
    pass.name = fmt::format("accumulate_{}", aov.name);
    pass.shader = "frame/accumulate";
    pass.reads = {{"source", image}};
    pass.writes = {{"mean", mean, SceneData::none, glm::vec4(0), true}};
    pass.note = note(rate);
    builder.beginTechnique("samples", "accumulate", rate);
    builder.add(std::move(pass));
    return mean;
}

}  // namespace

std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged) {
    std::vector<const Aov*> chosen;
    for (const Aov* aov : aovs)
        if (aov->isAveraged == averaged) chosen.push_back(aov);
    return chosen;
}

/// The plan; errors that name no file are the config's.
static FramePlan planOf(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame);

FramePlan planFrame(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame) {
    try {
        return planOf(config, facts, view, aovs, frame);
    } catch (const Error& error) {
        if (!error.where.file.empty() || error.code != ExitCode::usage) throw;
        throw Error(error.code, {config.file.string()}, error.problem, error.remedy);
    }
}

static FramePlan planOf(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame) {
    FramePlan result;
    EffectBuilder builder(result.graph, view, facts);
    std::vector<const TechniqueChoice*> choices{&config.geometry, &config.shading, &config.composite};
    if (config.ao) choices.push_back(&*config.ao);
    for (const auto& layer : config.edges) choices.push_back(&layer);
    builder.setChoices(std::move(choices));
    build(builder, config.geometry, frame);
    if (config.ao)
        build(builder, *config.ao, frame, Pass::Rate::occlusion);
    else
        result.graph.absent.emplace_back("ao");
    if (config.ao && !config.aoFilters.empty() && !builder.find(aov::ambientOcclusion))
        throw Error(ExitCode::usage, {config.file.string()},
            "the filter of [ao] has nothing to filter: ambient occlusion and lines are one image",
            "leave the filter out, or use another technique in one of both sections");
    for (const auto& filter : config.aoFilters) build(builder, filter, frame, Pass::Rate::occlusion);
    if (config.ao && config.aoFilters.empty()) result.graph.absent.emplace_back("filter");
    build(builder, config.shading, frame);
    for (std::size_t layer = 0; layer < config.edges.size(); ++layer) {
        builder.setLayer(static_cast<int>(layer));
        build(builder, config.edges[layer], frame);
    }
    builder.setLayer(0);
    if (config.edges.empty()) result.graph.absent.emplace_back("edges");
    build(builder, config.composite, frame);

    const bool sums = view.split.samples() > 1;
    for (const Aov* aov : aovs) {
        if (!builder.find(*aov))
            throw Error(ExitCode::usage, {config.file.string()},
                fmt::format("the AOV '{}' is asked for, but at frame {} nothing makes it", aov->name, frame),
                aov == &aov::ambientOcclusionError ? "only ao = \"ray_traced\" knows its error"
                    : aov == &aov::depthTangent    ? "only depth_tangent makes it"
                    : builder.find(aov::depthTangent)
                    ? "ask for depth_tangent: ambient occlusion and lines are one image"
                    : "raise the opacity of a line layer, or leave the AOV out");
        const ResourceId image =
            sums && aov->isAveraged ? accumulate(result.graph, builder, *aov, view) : builder.read(*aov);
        result.wanted.push_back({std::string(aov->name), image, view.keptGuard});
        result.aovs.push_back(aov);
    }
    result.usesFineRaster = builder.usesFineRaster();
    result.plan = compile(result.graph, result.wanted);
    return result;
}

Plan FramePlan::ofSample(const View& view) const {
    return narrow(graph, plan, wanted, [&](const Pass& pass) { return view.runs(pass.rate); });
}

}  // namespace limn
