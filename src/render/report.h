// The report of `limn plan`: the passes of a picture, and facts about it. No GL.
#pragma once

#include "render/pipeline.h"

namespace limn {

struct PlanReport {
    Pipeline pipeline;               ///< of the averaged AOVs, or of everything with one sample
    std::optional<Pipeline> centre;  ///< of the AOVs taken at the pixel's centre, when there are several samples
    PlanFacts facts;
};

/// Plans a frame. `maxTextureSize` is the driver's.
PlanReport reportPlan(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize = 16384);

}  // namespace limn
