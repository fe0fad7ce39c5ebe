// From a config to the passes of a picture: what could be drawn, what is wanted of it, and what therefore runs.
#pragma once

#include "graph/graph.h"
#include "picture/blocks.h"
#include "render/config.h"

#include <optional>

namespace limn {

/// The passes for some AOVs, compiled. Made once for all samples of a tile.
struct Pipeline {
    Graph graph;
    std::vector<Wanted> wanted;  ///< one per AOV, in the order of `aovs`
    std::vector<const Aov*> aovs;
    std::vector<int> summed;  ///< beside them: of how many samples the image is the sum
    Plan plan;
    bool usesFineRaster = false;  ///< something is drawn once for several samples

    /// What is to be done in the view's sample.
    Plan ofSample(const View& view) const;
};

/// `aovs`: what is wanted. With several samples the averaged ones are summed over them.
Pipeline buildPipeline(const RenderConfig& config, const SceneFacts& facts, const View& view,
    std::span<const Aov* const> aovs, double frame);

/// The AOVs that are averaged over a pixel's samples, or those that are taken at its centre.
std::vector<const Aov*> chooseAovs(std::span<const Aov* const> aovs, bool averaged);

/// Everything that is drawn of a tile: the averaged AOVs over all samples, and the others at the pixel's centre.
struct TilePipelines {
    Sampling sampling;
    int guard = 0;  ///< pixels drawn around the picture
    Pipeline averaged;
    std::optional<Pipeline> centre;
    View averagedView, centreView;

    SceneData sceneData() const;
};

ViewRequest viewRequest(
    const RenderConfig& config, const Sampling& sampling, int frame, int guard, int keptGuard, const Tile& tile = {});

/// `maxTextureSize` is the driver's; it may change how samples are split, not what the scene must bring.
TilePipelines buildPipelines(const RenderConfig& config, const SceneAt& scene, const SceneFacts& facts, int frame,
    int maxTextureSize, int keptGuard, const Tile& tile = {});

/// Names of the passes, in their order.
std::string passNames(const Pipeline& pipeline);

/// Does some pass look as far as there is anything? Tiles would then differ from the whole.
bool looksEverywhere(const Pipeline& pipeline);
/// May the picture be cut into tiles of any size, to the same bits?
bool takesAnyTile(const TilePipelines& pipelines);

/// How large the tiles of a picture may be. As large as memory allows, since what lies around each is drawn again and
/// again.
int chooseTileSize(const RenderConfig& config, const TilePipelines& pipelines, glm::ivec2 block);

}  // namespace limn
