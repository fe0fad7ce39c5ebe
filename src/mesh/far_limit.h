// The limit surface by Far's adaptive patches: for cages that Bfr 3.5 cannot take.
#pragma once

#include "mesh/far.h"

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTable.h>
#include <opensubdiv/far/ptexIndices.h>

namespace limn {

/// Evaluates a cage's limit surface anywhere. Threads may share one.
class FarLimit {
public:
    /// Refines `refiner` adaptively, `depth` levels deep around irregular vertices and creases. `points` and `uvs`: of
    /// the cage.
    FarLimit(OpenSubdiv::Far::TopologyRefiner& refiner, int depth, const std::vector<glm::dvec3>& points,
        const std::vector<glm::dvec2>& uvs);

    /// Position and derivatives at (s, t) of a part of a face: the face itself where it is regular, else the quarter at
    /// a corner.
    void evaluate(int face, int part, const glm::dvec2& st, glm::dvec3& point, glm::dvec3& ds, glm::dvec3& dt) const;
    glm::dvec2 uv(int face, int part, const glm::dvec2& st) const;

private:
    OpenSubdiv::Far::PtexIndices ptex_;
    std::unique_ptr<OpenSubdiv::Far::PatchTable> table_;
    std::unique_ptr<OpenSubdiv::Far::PatchMap> map_;
    std::vector<glm::dvec3> points_;  ///< of the cage, every level and the patches' own
    std::vector<glm::dvec2> uvs_;
};

}  // namespace limn
