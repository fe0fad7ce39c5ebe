// From a config to the graph of one sample of a frame, and what is wanted of it.
#pragma once

#include "graph/graph.h"
#include "render/config.h"

namespace limn {

struct FramePlan {
    Graph graph;
    std::vector<Wanted> wanted;  ///< one per AOV, in the order of `aovs`
    std::vector<const Aov*> aovs;
    Plan plan;
    bool usesFineRaster = false;  ///< something is drawn once for several samples

    /// What is to be done in the view's sample.
    Plan ofSample(const View& view) const;
};

/// `aovs`: what is wanted. With several samples the averaged ones are summed over them, and the result is their mean.
FramePlan planFrame(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame);

/// The AOVs that are averaged over a pixel's samples, or those that are taken at its centre.
std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged);

}  // namespace limn
