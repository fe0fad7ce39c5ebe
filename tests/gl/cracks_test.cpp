// A closed surface has no holes, wherever it stands.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace limn::test {
namespace {

TEST(Cracks, aClosedSubdivisionSurfaceFarFromTheOriginShowsNoBackground) {
    // A cube cage with creases and one five-sided corner cut, 150 000 units away; every background pixel whose
    // neighbours on all sides within two pixels are covered would be a hole.
    constexpr double far = 150000;
    std::string obj;
    for (int i = 0; i < 8; ++i)
        obj += fmt::format("v {} {} {}\n", far + (i & 1 ? 1 : -1), far + (i & 2 ? 1 : -1), -far + (i & 4 ? 1 : -1));
    obj +=
        "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\nt crease 2/1/0 0 1 2.5\nt crease 2/1/0 6 7 "
        "10\nt corner 1/1/0 3 3\n";
    std::uint64_t covered = 0, holes = 0;
    for (const char* subdivision : {"{ level = 5 }", "{ edge_length = '6px' }"})
        for (int view = 0; view < 12; ++view) {
            const double turn = 0.37 + view * 2.399963,
                         rise = std::asin(-0.95 + 1.9 * view / 11);  // spread over the sphere
            const glm::dvec3 centre(far, far, -far),
                eye = centre
                + 3.4 * glm::dvec3(std::cos(rise) * std::cos(turn), std::sin(rise), std::cos(rise) * std::sin(turn));
            const LoadedScene scene = makeScene(fmt::format("[[mesh]]\nname = 'm'\nfile = 'm.obj'\nsubdivision = "
                                                            "{}\n[[camera]]\nposition = {}\nlook_at = {}\nfov = 34\n",
                                                    subdivision, toml(eye), toml(centre)),
                {{"m.obj", obj}});
            const Picture picture = draw(makeConfig("[image]\nsize = [1000, 1000]\nbackground = '#ff00ff'\nsamples = "
                                                    "1\n[output]\naovs = ['beauty', 'object_id']\n"),
                scene);
            const Image& ids = picture.aov("object_id");
            const auto seen = [&](int x, int y) { return ids.at(x, y)[0] > 0; };
            for (int y = 2; y < 998; ++y)
                for (int x = 2; x < 998; ++x) {
                    if (seen(x, y)) {
                        ++covered;
                        continue;
                    }
                    holes += (seen(x - 1, y) || seen(x - 2, y)) && (seen(x + 1, y) || seen(x + 2, y))
                        && (seen(x, y - 1) || seen(x, y - 2)) && (seen(x, y + 1) || seen(x, y + 2));
                }
        }
    EXPECT_EQ(holes, 0u);
    EXPECT_GT(covered, 10000000u) << "pixels that were looked at";
}

// Two spheres side by side look equally large and share a mesh; one three times as far away has its own, of about a
// ninth of the triangles. Nothing is as coarse as the far one where it is near: edges span two pixels at most, of limit
// surfaces that are smaller than their cages.
TEST(EdgeLength, instancesOfOneSizeShareAMesh) {
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\nsubdivision = { edge_length = '2px', level = 8 }\n[[instance]]\nmesh = "
        "'m'\ntranslate = [-2, 0, 0]\n[[instance]]\nmesh = 'm'\ntranslate = [0, 0, -40]\n[[instance]]\nmesh = "
        "'m'\ntranslate = [2, 0, 0]\n[[camera]]\nposition = [0, 0, 20]\nlook_at = [0, 0, 0]\nfov = 30\n",
        {{"m.obj", boxObj({-1, -1, -1}, {1, 1, 1})}});
    const RenderConfig config = makeConfig("[image]\nsize = [640, 480]\nsamples = 1\n");
    const FrameRequest request = frameRequest(config, 1);
    const SceneAt at = sceneAt(scene, request);
    const MeshOrders orders = orderMeshes(scene, at, request, {});
    ASSERT_EQ(orders.orders.size(), 2u);
    EXPECT_EQ(orders.orderOf, (std::vector<std::size_t>{0, 1, 0}));
    MadeMeshes made = makeMeshes(scene, at, request, orders, [](const MeshOrder&) { return true; });
    ASSERT_EQ(made.meshes.size(), 2u);
    const auto mesh = [&](std::size_t i) -> const TriMesh& { return made.meshes.at(orders.orders[i].key); };
    const auto triangles = [&](std::size_t i) { return static_cast<double>(mesh(i).triangleCount()); };
    EXPECT_NEAR(triangles(0) / triangles(1), 9, 3);
    // Of the near spheres, 20 units away.
    const double pixelsPerUnit = 640 / (2 * std::tan(glm::radians(15.0))) / 19;
    double longest = 0;
    for (std::size_t i = 0; i < mesh(0).indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest,
                static_cast<double>(glm::distance(
                    mesh(0).positions[mesh(0).indices[i + k]], mesh(0).positions[mesh(0).indices[i + (k + 1) % 3]])));
    EXPECT_LE(longest * pixelsPerUnit, 2 * std::sqrt(2.0)) << "a square's diagonal";
}

}  // namespace
}  // namespace limn::test
