// The report of `limn plan`: the passes of a picture, and facts about it. No GL.
#pragma once

#include "render/pipeline.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

struct PlanReport {
    Pipeline pipeline;               ///< of the averaged AOVs, or of everything with one sample
    std::optional<Pipeline> centre;  ///< of the AOVs taken at the pixel's centre, when there are several samples
    PlanFacts facts;
};

/// Plans a frame. `maxTextureSize` is the driver's.
PlanReport reportPlan(
    const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize = kAnyTexture);

/// What a frame needs that the one before it did not leave behind.
struct FrameChange {
    int frame = 1;
    bool isSame = false;               ///< its pixels are the last frame's
    std::vector<std::string> reasons;  ///< "the camera moves", "2 of 14 objects move" ...
    std::vector<std::string> files;    ///< mesh files that are read for it
    std::size_t meshesMade = 0;        ///< turned into triangles
    int shadowMaps = 0;                ///< drawn
};

/// Compares the frames of a run, in its order: what is read, made and drawn for each, and why. Reads what they read.
std::vector<FrameChange> compareFrames(
    const RenderConfig& config, const LoadedScene& loaded, std::span<const int> frames);
std::string frameChangesText(const std::vector<FrameChange>& changes);
std::string frameChangesJson(const std::vector<FrameChange>& changes);

}  // namespace limn
