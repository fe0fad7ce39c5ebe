#include "render/scene_meshes.h"

#include "render/cutting.h"
#include "render/edge_rates.h"
#include "render/frame_plans.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

namespace limn {

SceneKey sceneKey(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneData needs) {
    SceneKey key{loaded.number, needs, {}, {}, scene.sections};
    const bool fitted = std::any_of(loaded.scene.meshes.begin(), loaded.scene.meshes.end(),
        [](const auto& mesh) { return mesh.subdivision.wantedEdge().has_value(); });
    if (fitted) key.fittedTo = fmt::format("{} {}x{}", config.camera, config.image.size.x, config.image.size.y);
    if (has(needs, SceneData::rays) || !scene.sections.empty())
        for (const auto& instance : scene.instances) key.places.push_back(instance.worldFromMesh);
    return key;
}

SceneMeshes buildMeshes(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneKey key) {
    const auto begin = std::chrono::steady_clock::now();
    SceneMeshes result;
    // Instances share meshes. Where edges are cut to look smooth to the camera only those that look about equally large
    // to it do.
    struct Build {
        std::size_t mesh;
        std::vector<std::size_t> instances;
    };
    std::vector<Build> builds;
    std::vector<int> classes(scene.instances.size());
    tbb::parallel_for(
        std::size_t{0}, scene.instances.size(), [&](std::size_t i) { classes[i] = edgeClass(loaded, i, config); });
    std::map<std::pair<std::size_t, int>, std::size_t> known;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
        const auto [at, isNew] = known.try_emplace({mesh, classes[i]}, builds.size());
        if (isNew) builds.push_back({mesh, {}});
        builds[at->second].instances.push_back(i);
        result.meshOf.push_back(static_cast<int>(at->second));
    }
    const MeshNeeds needs{has(key.needs, SceneData::normals), has(key.needs, SceneData::uvs),
        has(key.needs, SceneData::unifiedVertices), has(key.needs, SceneData::colors)};
    result.meshes.resize(builds.size());
    tbb::parallel_for(std::size_t{0}, builds.size(), [&](std::size_t i) {
        const PolyMesh& poly = loaded.meshes[builds[i].mesh].poly;
        auto subdivision = subdivisionOf(loaded.scene.meshes[builds[i].mesh], poly);
        if (!subdivision) return void(result.meshes[i] = buildTriMesh(poly, needs));
        subdivision->edgeRate = edgeRates(loaded, builds[i].instances, config);
        result.meshes[i] = subdivide(poly, *subdivision, needs, loaded.scene.meshes[builds[i].mesh].file);
    });
    if (!scene.sections.empty()) cutOpen(loaded, scene, needs, result.meshes, result.meshOf);
    result.key = std::move(key);
    result.milliseconds = std::chrono::duration < double;
    std::milli > (std::chrono::steady_clock::now() - begin).count();
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
