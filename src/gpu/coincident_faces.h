// Faces in one plane: draws those that others must hide a little farther from the eye.
//
// Rounding decides which of two such faces is nearer, pixel by pixel: ragged borders and hatching. Which one should be
// visible follows from the scene alone (mesh/coincident.h). Pixels are covered exactly as before, and what is seen is
// evaluated on its own plane: nothing else of the picture moves.
#pragma once

#include "gl/objects.h"
#include "mesh/coincident.h"

#include <span>
#include <vector>

namespace limn {

class CoincidentFaces {
public:
    /// `instances`: the number of each mesh's instance; `firstVertices`: where it begins in the scene's buffer of
    /// vertices.
    void find(std::span<const PlacedTriangles> meshes, std::span<const std::uint32_t> instances,
        std::span<const std::int32_t> firstVertices);
    void clear() { groups_.clear(), ownDraws_.clear(); }

    /// The triangles of an instance, ascending, that draw() draws and nobody else may.
    std::span<const std::uint32_t> drawnHere(std::uint32_t instance) const;

    /// Draws them into the depth buffer of the scene that is being drawn; vertices come from `inputs`.
    void draw(std::span<const gl::VertexInput> inputs) const;

private:
    struct Group {
        Side side;
        int level;
        gl::Buffer corners, commands;
        int commandCount;
    };
    std::vector<Group> groups_;
    std::vector<std::vector<std::uint32_t>> ownDraws_;  ///< of each instance
};

}  // namespace limn
