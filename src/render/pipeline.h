// From a config to the passes of a picture: the possible passes, the wanted images, and the passes that run for them.
#pragma once

#include "graph/graph.h"
#include "picture/blocks.h"
#include "render/config.h"

#include <optional>

namespace limn {

/// The compiled passes for some AOVs. Made once for all samples of a tile.
struct Pipeline {
    Graph graph;
    std::vector<Wanted> wanted;  ///< one per AOV, in the order of `aovs`
    std::vector<const Aov*> aovs;
    std::vector<int> summed;  ///< parallel to them: the number of samples in the image's sum
    Plan plan;
    bool usesFineRaster = false;  ///< some pass draws once for several samples

    /// The plan for the view's sample.
    Plan ofSample(const View& view) const;
};

/// `aovs`: the wanted ones. With several samples the averaged AOVs are summed over them.
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
    SceneData forVectors = SceneData::none;  ///< what lines read that are drawn as vectors

    SceneData sceneData() const;
};

ViewRequest viewRequest(
    const RenderConfig& config, const Sampling& sampling, int frame, int guard, int keptGuard, const Tile& tile = {});

/// The largest texture, where no driver is asked: what a picture needs does not depend on it.
inline constexpr int kAnyTexture = 16384;

/// `maxTextureSize` is the driver's; it may change the split of samples, but not the data that the scene must have.
TilePipelines buildPipelines(const RenderConfig& config, const SceneAt& scene, const SceneFacts& facts, int frame,
    int maxTextureSize, int keptGuard, const Tile& tile = {});

/// Names of the passes, in their order.
std::string passNames(const Pipeline& pipeline);

/// May some pass read any pixel? Tiles would then differ from the whole.
bool looksEverywhere(const Pipeline& pipeline);
/// May the picture be cut into tiles of any size, to the same bits?
bool takesAnyTile(const TilePipelines& pipelines);

/// The size of a picture's tiles. It is as large as memory allows, since each tile's guard band is drawn again.
int chooseTileSize(const RenderConfig& config, const TilePipelines& pipelines, glm::ivec2 block);

}  // namespace limn
