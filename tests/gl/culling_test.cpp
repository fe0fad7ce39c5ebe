// What cannot be seen need not be drawn, and whether it is drawn cannot be seen.

#include "gpu/culling.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace limn::test {
namespace {

/// A sheet far to the left, of n × n squares, from corner to corner the same for every n.
std::string sheetObj(int n) {
    std::string text;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) text += fmt::format("v -300 {} {}\n", 4.0 * y / n - 2, 4.0 * x / n - 2);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            text += fmt::format("f {0} {1} {2} {3}\n", y * (n + 1) + x + 1, y * (n + 1) + x + 2,
                (y + 1) * (n + 1) + x + 2, (y + 1) * (n + 1) + x + 1);
    return text;
}

/// Half of a sphere: open, so that its back sides are seen.
std::string bowlObj(double radius, int sides) {
    std::string text = sphereObj(radius, sides), kept;
    int face = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at) + 1;
        const bool isFace = text[at] == 'f';
        if (!isFace || face++ % sides < sides / 2) kept.append(text, at, end - at);
        at = end;
    }
    return kept;
}

struct Shot {
    const char* what;
    std::string camera;
};

TEST(Culling, changesNoBit) {
    // Small scenes are drawn whole, those of many triangles culled. The two scenes differ by how finely a sheet is cut
    // that no camera sees.
    const Shot shots[] = {
        {"from outside", cameraToml({3, 2, 6}, {0, 0, 0}, "fov = 40")},
        {"parallel rays", cameraToml({3, 2, 6}, {0, 0, 0}, "orthographic_height = 5")},
        {"from within the sphere", cameraToml({0.1, 0.2, 0.3}, {2, 0.3, 0}, "fov = 90")},
        {"from within the bowl, close", cameraToml({1.7, 0.05, 0.1}, {2.4, 0, 0}, "fov = 120")},
        {"through a long lens", cameraToml({300, 200, 600}, {0.9, 0.1, 0.2}, "fov = 0.05")},
    };
    const std::string scene =
        "[[mesh]]\nname = 'sphere'\nfile = 'sphere.obj'\n[[mesh]]\nname = 'bowl'\nfile = 'bowl.obj'\n[[mesh]]\nname = "
        "'mixed'\nfile = 'mixed.obj'\n[[mesh]]\nname = 'sheet'\nfile = 'sheet.obj'\n"
        "[[instance]]\nmesh = 'sphere'\n[[instance]]\nmesh = 'bowl'\ntranslate = [2, 0, 0]\nscale = [-1, 1.3, "
        "0.7]\n[[instance]]\nmesh = 'bowl'\ntranslate = [-2, 0.5, 0]\nrotate = [20, 130, 0]\n"
        "[[instance]]\nmesh = 'mixed'\ntranslate = [0, -3, 0]\n[[instance]]\nmesh = 'sheet'\n";
    for (const auto& shot : shots) {
        const auto load = [&](int cuts) {
            return makeScene(scene + shot.camera,
                {{"sphere.obj", sphereObj(1, 120)}, {"bowl.obj", bowlObj(0.8, 90)}, {"mixed.obj", mixedObj()},
                    {"sheet.obj", sheetObj(cuts)}});
        };
        const LoadedScene few = load(1), many = load(190);  // 72 200 triangles
        for (const char* image :
            {"samples = 1", "samples = 4", "samples = 1\ntile = 64", "samples = 1\nsize = [33, 21]"}) {
            const std::string size =
                std::string(image).find("size = ") == std::string::npos ? "size = [220, 160]\n" : "";
            const RenderConfig config = makeConfig("[image]\n" + size + image + "\n[shading]\n"
                "technique = 'lambert'\n[output]\naovs = ['beauty', 'depth', 'normal_geometric', 'object_id']\n");
            const Picture whole = draw(config, few), culled = draw(config, many);
            std::size_t seen = 0;
            for (const auto& layer : whole.frame.layers) {
                const Image& other = culled.aov(layer.name);
                ASSERT_EQ(layer.image.pixels.size(), other.pixels.size());
                EXPECT_EQ(
                    std::memcmp(layer.image.pixels.data(), other.pixels.data(), other.pixels.size() * sizeof(float)), 0)
                    << shot.what << ": " << layer.name << ", " << image;
                for (const float value : layer.image.pixels) seen += layer.name == "object_id" && value > 0;
            }
            EXPECT_GT(seen, whole.aov("object_id").pixels.size() / 10) << shot.what;
        }
    }
}

TEST(Culling, leavesOutWhatTurnsAwayAndWhatIsHidden) {
    // A sphere of 64 rings, seen from in front of it over 100 × 100 pixels: clip space has the depth in z.
    TriMesh mesh;
    constexpr int kRings = 64;
    for (int y = 0; y <= kRings; ++y)
        for (int x = 0; x <= 2 * kRings; ++x) {
            const double rise = std::acos(-1.0) * (static_cast<double>(y) / kRings - 0.5),
                         turn = std::acos(-1.0) * x / kRings;
            mesh.positions.emplace_back(
                std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
        }
    for (std::uint32_t y = 0; y < kRings; ++y)
        for (std::uint32_t x = 0; x < 2 * kRings; ++x) {
            const std::uint32_t a = y * (2 * kRings + 1) + x, b = a + 2 * kRings + 1;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    const auto clusters = makeClusters(mesh);
    CullView view;
    view.regionHigh = {100, 100};
    view.orthographic = true;
    PlacedMesh placed{clusters};
    placed.pixelFromMesh = glm::mat4(40, 0, 0, 0, 0, 40, 0, 0, 0, 0, 0.25f, 0, 50, 50, 0.5f, 1);
    placed.terms = placed.pixelFromMesh;
    placed.eye = {0, 0, 1};
    view.instances = {placed};
    const TriangleSource source{mesh.positions.data(), mesh.indices.data()};
    const auto count = [](const std::vector<SeenPart>& chosen) {
        std::size_t corners = 0;
        for (const auto& part : chosen) corners += part.indices.size();
        return corners / 3;
    };
    std::vector<SeenPart> chosen = partsOf(view);
    for (auto& part : chosen) chooseFacing(view, source, part);
    const std::size_t facing = count(chosen);
    EXPECT_LE(facing, mesh.triangleCount() / 2 + 2 * kRings) << "a half faces the camera";
    EXPECT_GT(facing, mesh.triangleCount() / 8);
    for (const auto& part : chosen)
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const glm::vec3 middle = (mesh.positions[part.indices[i]] + mesh.positions[part.indices[i + 1]]
                                         + mesh.positions[part.indices[i + 2]])
                / 3.0f;
            EXPECT_GT(middle.z, -0.05f);
        }
    for (auto& part : chosen) part.indices.clear();
    const auto first = chosen;

    FarthestDepths depths;
    depths.size = {25, 25};
    depths.values.assign(625, 0.0f);
    for (auto& part : chosen) chooseBacks(view, source, depths, part);
    const std::size_t backs = count(chosen);
    EXPECT_GT(backs, mesh.triangleCount() / 8) << "nothing has been drawn that could hide them";
    chosen = first;
    depths.values.assign(625, 0.5f);  // a wall through the sphere's middle
    for (auto& part : chosen) chooseBacks(view, source, depths, part);
    EXPECT_LT(count(chosen), backs / 8) << "only what touches the wall";
}

}  // namespace
}  // namespace limn::test
