#include "stage/meshes.h"

#include "stage/cutting.h"
#include "stage/edge_rates.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace limn {
namespace {

const MeshSource& sourceOf(const LoadedScene& loaded, const MeshOrder& order) {
    return loaded.scene.meshes[order.mesh];
}

/// Which of the scene's instances an order is for.
std::vector<std::size_t> sourcesOf(const SceneAt& scene, const MeshOrder& order) {
    std::vector<std::size_t> sources;
    for (const std::size_t instance : order.instances) sources.push_back(scene.instances[instance].source);
    return sources;
}

/// The content key of an order's whole mesh.
ContentKey wholeKey(const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request,
    const MeshNeeds& needs, const MeshOrder& order) {
    const MeshFile& file = *scene.meshes[order.mesh];
    KeyBuilder key;
    key.add(file.key.low).add(file.key.high);
    key.add(needs.normals).add(needs.uvs).add(needs.unified).add(needs.colors);
    if (const auto subdivision = subdivisionOf(sourceOf(loaded, order), file.poly)) {
        addSubdivision(key, *subdivision);
        addEdgeRates(key, loaded, sourcesOf(scene, order), request);
    }
    return key.key();
}

/// Content key of an order that may be cut: whole mesh, instance's transform, all sections.
ContentKey cutKey(const SceneAt& scene, const MeshOrder& order) {
    const glm::dmat4& world = scene.instances[order.instances.front()].worldFromMesh;
    KeyBuilder key;
    key.add(order.whole.low).add(order.whole.high).bytes(&world, sizeof world);
    for (const auto& section : scene.sections) key.bytes(&section, sizeof section);
    return key.key();
}

TriMesh makeWhole(const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request, const MeshNeeds& needs,
    const MeshOrder& order) {
    const PolyMesh& poly = scene.meshes[order.mesh]->poly;
    auto subdivision = subdivisionOf(sourceOf(loaded, order), poly);
    if (!subdivision || poly.faceCount() == 0) return buildTriMesh(poly, needs);
    subdivision->edgeRate = edgeRates(loaded, sourcesOf(scene, order), request);
    return subdivide(poly, *subdivision, needs, sourceOf(loaded, order).file);
}

}  // namespace

MeshOrders orderMeshes(
    const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request, const MeshNeeds& needs) {
    MeshOrders result;
    result.needs = needs;
    std::vector<int> classes(scene.instances.size());
    tbb::parallel_for(std::size_t{0}, scene.instances.size(),
        [&](std::size_t i) { classes[i] = edgeClass(loaded, scene, i, request); });
    std::map<std::pair<std::size_t, int>, std::size_t> known;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
        const auto [at, isNew] = known.try_emplace({mesh, classes[i]}, result.orders.size());
        if (isNew) result.orders.push_back({{}, mesh, {}, false, {}});
        result.orders[at->second].instances.push_back(i);
        result.orderOf.push_back(at->second);
    }
    for (auto& order : result.orders) {
        order.key = order.whole = wholeKey(loaded, scene, request, needs, order);
        result.wholes.emplace(order.key, order);
    }
    if (scene.sections.empty()) return result;

    std::vector<MeshOrder> each;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const MeshOrder& shared = result.orders[result.orderOf[i]];
        each.push_back({{}, shared.mesh, {i}, true, shared.whole});
        each.back().key = cutKey(scene, each.back());
        result.orderOf[i] = i;
    }
    result.orders = std::move(each);
    return result;
}

MadeMeshes makeMeshes(const LoadedScene& loaded, const SceneAt& scene, const FrameRequest& request,
    const MeshOrders& orders, const std::function<bool(const MeshOrder&)>& isWanted) {
    const auto begin = std::chrono::steady_clock::now();
    // Orders to be cut share their whole meshes.
    std::map<ContentKey, const MeshOrder*> wanted;
    std::vector<const MeshOrder*> cuts;
    for (const auto& order : orders.orders) {
        if (!isWanted(order)) continue;
        if (order.mayBeCut) cuts.push_back(&order);
        wanted.emplace(order.whole, &orders.wholes.at(order.whole));
    }
    const std::vector<std::pair<ContentKey, const MeshOrder*>> list(wanted.begin(), wanted.end());
    std::vector<TriMesh> made(list.size());
    tbb::parallel_for(std::size_t{0}, list.size(),
        [&](std::size_t i) { made[i] = makeWhole(loaded, scene, request, orders.needs, *list[i].second); });
    MadeMeshes result;
    for (std::size_t i = 0; i < list.size(); ++i) result.meshes[list[i].first] = std::move(made[i]);
    if (!cuts.empty()) cutOpen(scene, orders.needs, cuts, result);
    result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace limn
