#include "render/pipeline.h"

#include <fmt/format.h>

namespace limn {
namespace {

struct AccumulateConstants {
    bool first = false, last = false;
    float scale = 1;
    glm::ivec2 offset{0};
};
constexpr Field kAccumulate[] = {
    field<&AccumulateConstants::first>("first", {.doc = "Forget what was summed before."}),
    field<&AccumulateConstants::last>("last", {.doc = "Turn the sum into the mean."}),
    field<&AccumulateConstants::scale>("scale", {.doc = "One over the number of samples."}),
    field<&AccumulateConstants::offset>("offset", {.unit = "pixels", .doc = "Where the picture begins in what was drawn."}),
};

void build(EffectBuilder& builder, const TechniqueChoice& choice, double frame) {
    builder.beginTechnique(std::string(choice.technique->slot), std::string(choice.technique->name));
    choice.technique->build(builder, choice.at(frame).get(), *choice.technique);
}

/// The mean of an AOV over the samples of each pixel, as an image of the region without its guard band.
ResourceId accumulate(Graph& graph, EffectBuilder& builder, const Aov& aov, const View& view) {
    const Format format = info(aov.format).channels == 1 ? Format::r32f : Format::rgba32f;
    const ResourceId sum = graph.add({fmt::format("{}_mean", aov.name), format, view.region.size - 2 * view.guard, true});
    const int samples = view.split.samples();
    Pass pass;
    pass.name = fmt::format("accumulate_{}", aov.name);
    pass.shader = "frame/accumulate";
    pass.reads = {{"source", builder.read(aov)}};
    pass.writes = {{"sum", sum, SceneData::none, glm::vec4(0), true}};
    pass.params = paramsBlock(kAccumulate, AccumulateConstants{view.sample == 0, view.sample + 1 == samples, 1.0f / static_cast<float>(samples), glm::ivec2(view.guard)});
    pass.note = fmt::format("{} samples", samples);
    builder.beginTechnique("samples", "accumulate");
    builder.add(std::move(pass));
    return sum;
}

}  // namespace

std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged) {
    std::vector<const Aov*> chosen;
    for (const Aov* aov : aovs)
        if (aov->isAveraged == averaged) chosen.push_back(aov);
    return chosen;
}

/// The plan; errors that name no file are the config's.
static FramePlan planOf(const RenderConfig& config, const SceneFacts& facts, const View& view, std::span<const Aov* const> aovs, double frame);

FramePlan planFrame(const RenderConfig& config, const SceneFacts& facts, const View& view, std::span<const Aov* const> aovs, double frame) {
    try {
        return planOf(config, facts, view, aovs, frame);
    } catch (const Error& error) {
        if (!error.where.file.empty() || error.code != ExitCode::usage) throw;
        throw Error(error.code, {config.file.string()}, error.problem, error.remedy);
    }
}

static FramePlan planOf(const RenderConfig& config, const SceneFacts& facts, const View& view, std::span<const Aov* const> aovs, double frame) {
    FramePlan result;
    EffectBuilder builder(result.graph, view, facts);
    std::vector<const TechniqueChoice*> choices{&config.geometry, &config.shading, &config.composite};
    if (config.ao) choices.push_back(&*config.ao);
    for (const auto& layer : config.edges) choices.push_back(&layer);
    builder.setChoices(std::move(choices));
    build(builder, config.geometry, frame);
    if (config.ao) build(builder, *config.ao, frame);
    else result.graph.absent.emplace_back("ao");
    if (config.ao && !config.aoFilters.empty() && !builder.find(aov::ambientOcclusion))
        throw Error(ExitCode::usage, {config.file.string()}, "the filter of [ao] has nothing to filter: ambient occlusion and lines are one image", "leave the filter out, or use another technique in one of both sections");
    for (const auto& filter : config.aoFilters) build(builder, filter, frame);
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
            throw Error(ExitCode::usage, {config.file.string()}, fmt::format("the AOV '{}' is asked for, but at frame {} nothing makes it", aov->name, frame), aov == &aov::ambientOcclusionError ? "only ao = \"ray_traced\" knows its error" : aov == &aov::depthTangent ? "only depth_tangent makes it" : builder.find(aov::depthTangent) ? "ask for depth_tangent: ambient occlusion and lines are one image" : "raise the opacity of a line layer, or leave the AOV out");
        const ResourceId image = sums && aov->isAveraged ? accumulate(result.graph, builder, *aov, view) : builder.read(*aov);
        result.wanted.push_back({std::string(aov->name), image, view.keptGuard});
        result.aovs.push_back(aov);
    }
    result.usesFineRaster = builder.usesFineRaster();
    result.plan = compile(result.graph, result.wanted);
    return result;
}

}  // namespace limn
