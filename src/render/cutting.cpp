#include "render/cutting.h"

#include "base/log.h"
#include "geometry/section.h"

#include <tbb/parallel_for.h>

namespace limn {

void cutOpen(const LoadedScene& loaded, const DrawScene& scene, const MeshNeeds& needs, std::vector<TriMesh>& meshes,
    std::vector<int>& meshOf) {
    std::vector<TriMesh> cut(scene.instances.size());
    std::vector<char> isOwn(scene.instances.size());
    std::vector<std::size_t> open(scene.instances.size());
    tbb::parallel_for(std::size_t{0}, scene.instances.size(), [&](std::size_t i) {
        const DrawInstance& instance = scene.instances[i];
        const TriMesh* mesh = &meshes[static_cast<std::size_t>(meshOf[i])];
        const PolyMesh& poly = loaded.meshes[static_cast<std::size_t>(instance.mesh)].poly;
        const glm::dmat3 linear(instance.worldFromMesh);
        const glm::dvec3 pivot(instance.worldFromMesh * glm::dvec4(mesh->pivot, 1));
        for (std::size_t s = 0; s < scene.sections.size(); ++s) {
            const SectionPlane& section = scene.sections[s];
            const CutPlane plane{glm::transpose(linear) * section.normal,
                glm::dot(section.normal, pivot - section.point),
                static_cast<std::uint32_t>(poly.materialNames.size() + s),
                static_cast<std::uint32_t>(poly.partNames.size())};
            if (!isCut(*mesh, plane)) continue;
            CutMesh done = cutMesh(*mesh, plane, needs);
            open[i] += done.openOutlines;
            cut[i] = std::move(done.mesh);
            mesh = &cut[i];
            isOwn[i] = true;
        }
        if (isOwn[i] && !needs.unified) numberByLastVertex(cut[i]);
    });
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (open[i] > 0)
            log::warning("object '{}' is not closed where a section cuts it: {} outline{} without a cut face",
                scene.instances[i].name, open[i], open[i] == 1 ? "" : "s");
        if (!isOwn[i]) continue;
        meshOf[i] = static_cast<int>(meshes.size());
        meshes.push_back(std::move(cut[i]));
    }
    // What only cut instances showed is no longer needed.
    std::vector<char> used(meshes.size());
    for (const int mesh : meshOf) used[static_cast<std::size_t>(mesh)] = true;
    for (std::size_t m = 0; m < meshes.size(); ++m)
        if (!used[m]) meshes[m] = {};
}

}  // namespace limn
