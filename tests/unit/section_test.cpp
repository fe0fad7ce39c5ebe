// Meshes cut open: what is left is a closed body of the right volume, and its cut face has the right area.

#include "mesh/section.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

namespace limn {
namespace {

/// Boxes as closed, outward triangles.
TriMesh boxes(const std::vector<std::array<glm::vec3, 2>>& list, bool inwards = false) {
    TriMesh mesh;
    for (const auto& [lo, hi] : list) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i < 8; ++i)
            mesh.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
        constexpr std::uint32_t quads[6][4] = {
            {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (const auto& q : quads)
            for (const int k : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + q[inwards ? 3 - k : k]);
    }
    mesh.normals.assign(1, {0, 0, 1});
    mesh.normalIndices.assign(mesh.indices.size(), 0);
    return mesh;
}

struct Measure {
    double volume = 0, cutArea = 0;
    int openEdges = 0;
};

Measure measure(const TriMesh& mesh, std::uint32_t cutMaterial) {
    Measure m;
    std::map<std::array<float, 6>, int> edges;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const glm::vec3 p[3] = {mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
            mesh.positions[mesh.indices[3 * t + 2]]};
        const glm::dvec3 a(p[0]), b(p[1]), c(p[2]);
        m.volume += glm::dot(a, glm::cross(b, c)) / 6;
        if (!mesh.triangleMaterial.empty() && mesh.triangleMaterial[t] == cutMaterial)
            m.cutArea += glm::length(glm::cross(b - a, c - a)) / 2;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 from = p[k], to = p[(k + 1) % 3];
            ++edges[{from.x, from.y, from.z, to.x, to.y, to.z}];
            --edges[{to.x, to.y, to.z, from.x, from.y, from.z}];
        }
    }
    for (const auto& [edge, count] : edges) m.openEdges += count != 0;
    return m;
}

const MeshNeeds kNeeds{.normals = true};

TEST(Section, halfABoxIsClosedAndHasHalfTheVolume) {
    const TriMesh box = boxes({{glm::vec3(-1, -2, -3), glm::vec3(1, 2, 3)}});
    for (const glm::dvec3& direction :
        {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0.3, 0.5, 0.8), glm::dvec3(-1, 1, 0.1)}) {
        const CutMesh cut = cutMesh(box, {direction, 0, 7, 1}, kNeeds);  // through the centre
        const Measure m = measure(cut.mesh, 7);
        EXPECT_NEAR(m.volume, 24, 1e-4);
        EXPECT_EQ(m.openEdges, 0);
        EXPECT_EQ(cut.openOutlines, 0u);
        EXPECT_GT(m.cutArea, 7.9);
    }
    const Measure level = measure(cutMesh(box, {{0, 0, 2}, -2, 7, 1}, kNeeds).mesh, 7);  // at z = 1
    EXPECT_NEAR(level.cutArea, 8, 1e-6);
    EXPECT_NEAR(level.volume, 32, 1e-5);
}

TEST(Section, twoPlanesCutAQuarter) {
    const TriMesh box = boxes({{glm::vec3(-1), glm::vec3(1)}});
    const CutMesh half = cutMesh(box, {{1, 0, 0}, 0, 7, 1, 1}, kNeeds);
    const CutMesh quarter = cutMesh(half.mesh, {{0, 1, 0}, 0, 8, 1}, kNeeds);
    const Measure m = measure(quarter.mesh, 8);
    EXPECT_NEAR(m.volume, 2, 1e-6);
    EXPECT_NEAR(m.cutArea, 2, 1e-6);
    EXPECT_NEAR(measure(quarter.mesh, 7).cutArea, 2, 1e-6) << "the first cut's face is cut by the second";
}

TEST(Section, solidsInOneAnotherAreFilledOnceAndHolesStayOpen) {
    const CutPlane level{{0, 0, 1}, 0, 7, 1, 1};
    const TriMesh nested = boxes({{glm::vec3(-2), glm::vec3(2)}, {glm::vec3(-1), glm::vec3(3)}});
    EXPECT_NEAR(measure(cutMesh(nested, level, kNeeds).mesh, 7).cutArea, 16 + 16 - 9, 1e-5);
    TriMesh hollow = boxes({{glm::vec3(-2), glm::vec3(2)}});
    const TriMesh cavity = boxes({{glm::vec3(-1), glm::vec3(1)}}, true);
    for (const auto i : cavity.indices) {
        hollow.indices.push_back(i + 8);
        hollow.normalIndices.push_back(0);
    }
    hollow.positions.insert(hollow.positions.end(), cavity.positions.begin(), cavity.positions.end());
    const CutMesh cut = cutMesh(hollow, level, kNeeds);
    EXPECT_NEAR(measure(cut.mesh, 7).cutArea, 16 - 4, 1e-5);
    EXPECT_EQ(measure(cut.mesh, 7).openEdges, 0);
}

TEST(Section, surfacesWithoutThicknessAreCutButNotFilled) {
    TriMesh sheet;
    sheet.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    sheet.indices = {0, 1, 2, 0, 2, 3};
    const CutMesh cut = cutMesh(sheet, {{0, 0, 1}, 0, 7, 1, 1}, {});
    EXPECT_EQ(cut.openOutlines, 1u);
    double length = 0;
    for (const Segment& segment : cut.mesh.segments) {
        EXPECT_TRUE(segment.isCut && segment.a.y == 0 && segment.a.z == 0 && segment.material == 7);
        length += static_cast<double>(glm::distance(segment.a, segment.b));
    }
    EXPECT_NEAR(length, 2, 1e-6) << "the sheet leaves its line";
    EXPECT_EQ(measure(cut.mesh, 7).cutArea, 0);
    EXPECT_TRUE(isCut(sheet, {{0, 0, 1}, 0, 7, 1, 1}));
    EXPECT_FALSE(isCut(sheet, {{0, 0, 1}, -1, 7, 1, 1})) << "a plane that only touches takes nothing away";
}

TEST(Section, everyMaterialIsFilledByItself) {
    // Two boxes of brick that overlap, one of concrete that touches both along a face, all in one mesh.
    TriMesh wall = boxes({{glm::vec3(0, 0, -1), glm::vec3(3, 1, 1)}, {glm::vec3(2, 0, -1), glm::vec3(5, 1, 1)},
        {glm::vec3(0, 1, -1), glm::vec3(5, 1.5f, 1)}});
    for (std::uint32_t t = 0; t < wall.triangleCount(); ++t) wall.triangleMaterial.push_back(t < 24 ? 0 : 1);
    const CutMesh cut = cutMesh(wall, {{0, 0, 1}, 0, 4, 2, 1}, kNeeds);
    EXPECT_EQ(cut.openOutlines, 0u);
    EXPECT_NEAR(measure(cut.mesh, 4).cutArea, 5, 1e-5);
    EXPECT_NEAR(measure(cut.mesh, 5).cutArea, 2.5, 1e-5);
}

TEST(Section, aSolidHasTheMaterialOfMostOfItsOutline) {
    TriMesh box = boxes({{glm::vec3(-1), glm::vec3(1)}});  // one side plastered
    for (std::uint32_t t = 0; t < box.triangleCount(); ++t) box.triangleMaterial.push_back(t >= 10 ? 1 : 0);
    const CutMesh cut = cutMesh(box, {{0, 0, 1}, 0, 2, 2, 1}, kNeeds);
    EXPECT_NEAR(measure(cut.mesh, 2).cutArea, 4, 1e-5);
    EXPECT_EQ(measure(cut.mesh, 3).cutArea, 0);
}

TEST(Section, linesAreCutToo) {
    TriMesh lines;
    lines.segments = {{{0, 0, -1}, {0, 0, 3}}, {{1, 0, 1}, {1, 0, 2}}, {{2, 0, -2}, {2, 0, -1}}};
    ASSERT_TRUE(isCut(lines, {{0, 0, 1}, 0, 1, 1, 1}));
    const auto left = cutMesh(lines, {{0, 0, 1}, 0, 1, 1, 1}, {}).mesh.segments;
    ASSERT_EQ(left.size(), 2u);
    EXPECT_EQ(left[0].b, glm::vec3(0, 0, 0));
    EXPECT_EQ(left[1].b, glm::vec3(2, 0, -1));
}

}  // namespace
}  // namespace limn
