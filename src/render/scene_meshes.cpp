#include "render/scene_meshes.h"

#include "render/cutting.h"
#include "render/edge_rates.h"
#include "render/frame_plans.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>

namespace limn {

SceneKey sceneKey(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneData needs) {
    SceneKey key{loaded.number, needs, {}, {}, scene.sections};
    const bool fitted = std::any_of(loaded.scene.meshes.begin(), loaded.scene.meshes.end(), [](const auto& mesh) { return mesh.subdivision.wantedEdge().has_value(); });
    if (fitted) key.fittedTo = fmt::format("{} {}x{}", config.camera, config.image.size.x, config.image.size.y);
    if (has(needs, SceneData::rays) || !scene.sections.empty())
        for (const auto& instance : scene.instances) key.places.push_back(instance.worldFromMesh);
    return key;
}

SceneMeshes buildMeshes(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneKey key) {
    const auto begin = std::chrono::steady_clock::now();
    SceneMeshes result;
    // Edges that are cut to look smooth to the camera need a mesh per instance; else instances share theirs.
    struct Build { std::size_t mesh; std::optional<std::size_t> instance; };
    std::vector<Build> builds;
    std::vector<int> shared(loaded.meshes.size(), -1);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
        const bool own = loaded.scene.meshes[mesh].subdivision.wantedEdge().has_value();
        if (own || shared[mesh] < 0) {
            if (!own) shared[mesh] = static_cast<int>(builds.size());
            result.meshOf.push_back(static_cast<int>(builds.size()));
            builds.push_back({mesh, own ? std::optional(i) : std::nullopt});
        } else {
            result.meshOf.push_back(shared[mesh]);
        }
    }
    const MeshNeeds needs{has(key.needs, SceneData::normals), has(key.needs, SceneData::uvs), has(key.needs, SceneData::unifiedVertices), has(key.needs, SceneData::colors)};
    result.meshes.resize(builds.size());
    tbb::parallel_for(std::size_t{0}, builds.size(), [&](std::size_t i) {
        const PolyMesh& poly = loaded.meshes[builds[i].mesh].poly;
        auto subdivision = subdivisionOf(loaded.scene.meshes[builds[i].mesh], poly);
        if (!subdivision) return void(result.meshes[i] = buildTriMesh(poly, needs));
        if (builds[i].instance) subdivision->edgeRate = edgeRates(loaded, *builds[i].instance, config);
        result.meshes[i] = subdivide(poly, *subdivision, needs, loaded.scene.meshes[builds[i].mesh].file);
    });
    if (!scene.sections.empty()) cutOpen(loaded, scene, needs, result.meshes, result.meshOf);
    result.key = std::move(key);
    result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

SceneMeshes buildMeshes(const RenderConfig& config, const LoadedScene& loaded, int frame) {
    const DrawScene scene = resolveFrame(loaded, frameRequest(config, frame));
    const PixelRect firstBlock{glm::ivec2(0), largestBlock(config.image.size)};
    constexpr int kAnySize = 16384;
    const FramePlans plans = planBoth(config, scene, sceneFacts(scene), frame, kAnySize, 0, {firstBlock, firstBlock});
    return buildMeshes(config, loaded, scene, sceneKey(config, loaded, scene, plans.sceneData()));
}

}  // namespace limn
