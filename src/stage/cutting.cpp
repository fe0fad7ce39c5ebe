#include "stage/cutting.h"

#include "base/log.h"
#include "mesh/section.h"

#include <tbb/parallel_for.h>

#include <optional>
#include <set>

namespace limn {
namespace {

struct Cut {
    std::optional<TriMesh> mesh;  ///< nullopt: no section reaches the instance
    std::size_t openOutlines = 0;
};

Cut cutInstance(const SceneAt& scene, const MeshNeeds& needs, const DrawInstance& instance, const TriMesh& whole) {
    Cut result;
    const PolyMesh& poly = scene.meshes[static_cast<std::size_t>(instance.mesh)]->poly;
    const glm::dmat3 linear(instance.worldFromMesh);
    const glm::dvec3 pivot(instance.worldFromMesh * glm::dvec4(whole.pivot, 1));
    const TriMesh* mesh = &whole;
    for (std::size_t s = 0; s < scene.sections.size(); ++s) {
        const SectionPlane& section = scene.sections[s];
        const CutPlane plane{glm::transpose(linear) * section.normal, glm::dot(section.normal, pivot - section.point),
            static_cast<std::uint32_t>((1 + s) * poly.materialNames.size()),
            static_cast<std::uint32_t>(poly.materialNames.size()), static_cast<std::uint32_t>(poly.partNames.size())};
        if (!isCut(*mesh, plane)) continue;
        CutMesh done = cutMesh(*mesh, plane, needs);
        result.openOutlines += done.openOutlines;
        result.mesh = std::move(done.mesh);
        mesh = &*result.mesh;
    }
    if (result.mesh && !needs.unified) numberByLastVertex(*result.mesh);
    return result;
}

}  // namespace

void cutOpen(const SceneAt& scene, const MeshNeeds& needs, std::span<const MeshOrder* const> orders, MadeMeshes& made) {
    std::vector<Cut> cuts(orders.size());
    tbb::parallel_for(std::size_t{0}, orders.size(), [&](std::size_t i) {
        const DrawInstance& instance = scene.instances[orders[i]->instances.front()];
        cuts[i] = cutInstance(scene, needs, instance, made.meshes.at(orders[i]->whole));
    });
    std::set<ContentKey> shown;
    for (std::size_t i = 0; i < orders.size(); ++i) {
        const std::size_t open = cuts[i].openOutlines;
        if (open > 0)
            log::warning(
                "object '{}' is not closed where a section cuts it: {} outline{} without a cut face, drawn as lines",
                scene.instances[orders[i]->instances.front()].name, open, open == 1 ? "" : "s");
        if (!cuts[i].mesh) {
            made.shownAs[orders[i]->key] = orders[i]->whole;
            shown.insert(orders[i]->whole);
        }
    }
    for (const MeshOrder* order : orders)
        if (!shown.contains(order->whole)) made.meshes.erase(order->whole);
    for (std::size_t i = 0; i < orders.size(); ++i)
        if (cuts[i].mesh) made.meshes[orders[i]->key] = std::move(*cuts[i].mesh);
}

}  // namespace limn
