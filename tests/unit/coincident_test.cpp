// Which triangles lie on others is known from the scene alone.

#include "mesh/coincident.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace limn {
namespace {

struct Sheet {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;

    PlacedTriangles placed(const glm::dmat4& world = glm::dmat4(1)) const { return {positions, indices, world}; }
};

/// A grid of `cells` by `cells` squares of side 1, curved by `bend`.
Sheet grid(int cells, double bend = 0, bool turned = false) {
    Sheet sheet;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) sheet.positions.emplace_back(x, y, bend * x * x + bend * y * y);
    const auto side = static_cast<std::uint32_t>(cells) + 1;
    for (std::uint32_t y = 0; y + 1 < side; ++y)
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t a = y * side + x;
            for (const auto i : {a, a + 1, a + side + 1, a, a + side + 1, a + side}) sheet.indices.push_back(i);
        }
    if (turned)
        for (std::size_t t = 0; t < sheet.indices.size(); t += 3) std::swap(sheet.indices[t + 1], sheet.indices[t + 2]);
    return sheet;
}

TEST(Coincident, neighboursInOnePlaneAreNone) {
    for (const double bend : {0.0, 0.01}) {
        const Sheet sheet = grid(60, bend);
        const PlacedTriangles one[] = {sheet.placed()};
        EXPECT_TRUE(findCoincident(one).empty());
        EXPECT_EQ(countCovered(one[0]), 0u);
    }
}

TEST(Coincident, copiesLieOnTheFirst) {
    for (const double bend : {0.0, 0.01}) {
        const Sheet sheet = grid(20, bend);
        const PlacedTriangles both[] = {sheet.placed(), sheet.placed()};
        const auto found = findCoincident(both);
        ASSERT_EQ(found.size(), 800u);
        for (const auto& one : found) EXPECT_EQ(one, (CoincidentTriangle{1, one.triangle, Side::both, 1}));
    }
}

TEST(Coincident, turnedCopiesLetTheOneThatFacesWin) {
    const Sheet front = grid(4), back = grid(4, 0, true);
    const PlacedTriangles both[] = {front.placed(), back.placed()};
    const auto found = findCoincident(both);
    ASSERT_EQ(found.size(), 128u);
    for (std::size_t i = 0; i < found.size(); ++i) {  // fronts stay where they are, backs are hidden
        EXPECT_EQ(found[i].side, i < 64 ? Side::front : Side::back);
        EXPECT_EQ(found[i].level, i < 64 ? 0 : 1);
    }
}

TEST(Coincident, aPlaneBesideIsAnother) {
    const Sheet sheet = grid(8);
    // The scene is 8 * sqrt(2) across: half and five times the distance within which planes are one.
    const double near = kCoincidentDistance * 8 * std::sqrt(2.0);
    const auto beside = [&](double distance) {
        const PlacedTriangles both[] = {
            sheet.placed(), sheet.placed(glm::translate(glm::dmat4(1), glm::dvec3(0.3, 0.2, distance)))};
        return findCoincident(both).size();
    };
    EXPECT_GT(beside(0.5 * near), 0u);
    EXPECT_EQ(beside(5 * near), 0u);
}

TEST(Coincident, aStackIsInTheOrderOfItsMeshes) {
    const Sheet sheet = grid(1);
    const PlacedTriangles stack[] = {sheet.placed(), sheet.placed(), sheet.placed()};
    for (const auto& one : findCoincident(stack)) EXPECT_EQ(one.level, static_cast<int>(one.mesh));
}

TEST(Coincident, movingAndScalingTheSceneChangesNothing) {
    const Sheet large = grid(3), small = grid(2);
    const auto count = [&](const glm::dmat4& world) {
        const glm::dmat4 inside =
            glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(1.3, 0.4, 0)), 0.7, glm::dvec3(0, 0, 1));
        const PlacedTriangles both[] = {large.placed(world), small.placed(world * inside)};
        return findCoincident(both);
    };
    const auto here = count(glm::dmat4(1));
    EXPECT_FALSE(here.empty());
    for (const double scale : {1e-9, 1.0, 1e9}) {
        const glm::dmat4 world = glm::rotate(
            glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(1e6, -3e5, 2e6) * scale), glm::dvec3(scale)), 1.1,
            glm::normalize(glm::dvec3(1, 2, 3)));
        EXPECT_EQ(count(world), here) << scale;
    }
}

}  // namespace
}  // namespace limn
