#include "gpu/coincident_faces.h"

#include <algorithm>

namespace limn {
namespace {

// Both faces' corners lie off their places by up to half a step of the grid of 1/256 pixel, in x and in y: their depths
// differ by up to the change over four such halves.
constexpr float kPixelsPerLevel = 4 / 512.0f;

// Depths are floats, and planes kCoincidentDistance apart are one: 2e-6 of a distance are about 24 of its ulps.
constexpr float kRoundingsPerLevel = 24;

}  // namespace

void CoincidentFaces::find(std::span<const PlacedTriangles> meshes, std::span<const std::uint32_t> instances,
    std::span<const std::int32_t> firstVertices) {
    clear();
    const auto found = findCoincident(meshes);
    for (const auto& one : found) {
        ownDraws_.resize(std::max<std::size_t>(ownDraws_.size(), instances[one.mesh] + 1));
        ownDraws_[instances[one.mesh]].push_back(one.triangle);
    }
    for (auto& own : ownDraws_) {
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
    }
    for (std::size_t from = 0, to = 0; from < found.size(); from = to) {
        std::vector<std::uint32_t> corners;
        std::vector<gl::DrawCommand> commands;
        for (; to < found.size() && found[to].side == found[from].side && found[to].level == found[from].level; ++to) {
            const std::uint32_t mesh = found[to].mesh;
            if (to == from || mesh != found[to - 1].mesh)
                commands.push_back(
                    {0, 1, static_cast<std::uint32_t>(corners.size()), firstVertices[mesh], instances[mesh]});
            commands.back().count += 3;
            const auto triangle = meshes[mesh].indices.subspan(3 * std::size_t{found[to].triangle}, 3);
            corners.insert(corners.end(), triangle.begin(), triangle.end());
        }
        groups_.push_back(
            {found[from].side, found[from].level, gl::Buffer(std::as_bytes(std::span(corners)), "coincident faces"),
                gl::Buffer(std::as_bytes(std::span(commands)), "draw commands"), static_cast<int>(commands.size())});
    }
}

std::span<const std::uint32_t> CoincidentFaces::drawnHere(std::uint32_t instance) const {
    return instance < ownDraws_.size() ? std::span<const std::uint32_t>(ownDraws_[instance])
                                       : std::span<const std::uint32_t>();
}

void CoincidentFaces::draw(std::span<const gl::VertexInput> inputs) const {
    for (const Group& group : groups_) {
        const auto level = static_cast<float>(group.level);
        const gl::PushedBack farther(kPixelsPerLevel * level, kRoundingsPerLevel * level,
            group.side == Side::front      ? gl::Facing::front
                : group.side == Side::back ? gl::Facing::back
                                           : gl::Facing::any);
        const gl::VertexArray array(inputs, group.corners, "coincident faces");
        array.bind();
        gl::drawElements(group.commands, group.commandCount);
    }
}

}  // namespace limn
