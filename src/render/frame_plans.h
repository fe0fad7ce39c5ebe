// How a picture is drawn as a whole: its samples, its guard band, its blocks and tiles, and the plans of both kinds of
// AOV.
#pragma once

#include "render/loader.h"
#include "render/pipeline.h"

#include <optional>
#include <utility>
#include <vector>

namespace limn {

/// A part of a picture, in pixels from the lower left: the block that its triangles are drawn with, and itself.
struct Tile {
    PixelRect block, rect;
};

/// Both plans of a frame: the averaged AOVs over all samples, and the others at the pixel's centre.
struct FramePlans {
    SampleSplit split;
    int guard = 0;  ///< pixels drawn around the picture
    FramePlan averaged;
    std::optional<FramePlan> centre;
    View averagedView, centreView;

    SceneData sceneData() const;
};

ViewRequest viewRequest(
    const RenderConfig& config, const SampleSplit& split, int frame, int guard, int keptGuard, const Tile& tile = {});

/// `maxTextureSize` is the driver's; it may change how samples are split, not what the scene must bring.
FramePlans planBoth(const RenderConfig& config, const DrawScene& scene, const SceneFacts& facts, int frame,
    int maxTextureSize, int keptGuard, const Tile& tile = {});

/// Names of the passes, in their order.
std::string planSummary(const FramePlan& frame);

/// Large pictures are made of blocks, each drawn with triangles of its own: below every driver's limit, and small
/// enough for memory. They are part of what a picture is: tiles of any size give the same bits.
int largestBlockSide(glm::ivec2 size);
glm::ivec2 largestBlock(glm::ivec2 size);

/// Cuts [0, length) into spans of at most `most`, begun at multiples of four: what is drawn at half the size keeps its
/// place.
std::vector<std::pair<int, int>> spans(int length, int most);

/// Does some pass look as far as there is anything? Tiles would then differ from the whole.
bool looksEverywhere(const FramePlan& frame);

/// How large the tiles of a picture may be. As large as memory allows, since what lies around each is drawn again and
/// again.
int chooseTileSize(const RenderConfig& config, const FramePlans& plans, glm::ivec2 block);

/// A plan and the pictures it would make: what `limn plan` shows.
struct ExplainedPlan {
    FramePlan frame;                  ///< of the averaged AOVs, or of everything with one sample
    std::optional<FramePlan> centre;  ///< of the AOVs taken at the pixel's centre, when there are several samples
    PlanFacts facts;
};

/// Plans a frame without GL.
ExplainedPlan planConfig(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize = 16384);

}  // namespace limn
