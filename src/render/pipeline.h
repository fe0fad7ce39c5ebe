// From a config to the graph of one sub-frame, and what is wanted of it.
#pragma once

#include "graph/graph.h"
#include "render/config.h"

namespace limn {

struct FramePlan {
    Graph graph;
    std::vector<Wanted> wanted;         ///< one per AOV, in the order of `aovs`
    std::vector<const Aov*> aovs;
    Plan plan;
};

/// `aovs`: what is wanted of this sub-frame. With several samples the averaged ones are summed over sub-frames, and the result is the sum.
FramePlan planFrame(const RenderConfig& config, const SceneFacts& facts, const View& view, const SampleSplit& split, std::span<const Aov* const> aovs, double frame);

/// The AOVs that are averaged over a pixel's samples, or those that are taken at its centre.
std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged);

}  // namespace limn
