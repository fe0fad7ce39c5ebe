// Faces in one plane: one wins everywhere, whatever the camera, the order of files and the way they are cut into
// triangles.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace limn::test {
namespace {

constexpr int kViews = 36;

/// A place in a plane that no axis lies in.
glm::dvec3 onPlane(double u, double v) {
    return glm::dvec3(0.3, 0.1, -0.2) + u * glm::normalize(glm::dvec3(3, 0.4, 0.7))
        + v * glm::normalize(glm::cross(glm::dvec3(3, 0.4, 0.7), glm::dvec3(0.2, 1.1, 0.3)));
}

/// A grid of quads over a rectangle in that plane, turned by `angle` (radians). Faces of more corners are cut into
/// triangles as the file lists them: `shift` moves the first.
std::string sheet(double width, double height, double angle, int cells, int shift, bool turned) {
    std::string text;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const double u = width * (x / static_cast<double>(cells) - 0.5),
                         v = height * (y / static_cast<double>(cells) - 0.5);
            const glm::dvec3 p =
                onPlane(u * std::cos(angle) - v * std::sin(angle), u * std::sin(angle) + v * std::cos(angle));
            text += fmt::format("v {:.6g} {:.6g} {:.6g}\n", p.x, p.y, p.z);
        }
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int first = 1 + y * (cells + 1) + x;
            const int corners[4] = {first, first + 1, first + cells + 2, first + cells + 1};
            text += "f";
            for (int i = 0; i < 4; ++i) text += fmt::format(" {}", corners[((turned ? 3 - i : i) + shift) % 4]);
            text += "\n";
        }
    return text;
}

const std::string kGround = sheet(4, 4, 0, 3, 0, false), kDecal = sheet(1.5, 1.1, 0.37, 2, 1, false),
                  kBack = sheet(4, 4, 0, 3, 1, true);

/// The object seen by each pixel of a view around the plane, at both its sides.
std::vector<int> objects(const std::vector<std::string>& files, int view, double distance = 7) {
    std::string scene;
    std::vector<std::pair<std::string, std::string>> named;
    for (const auto& file : files) {
        const std::string name = fmt::format("m{}", named.size());
        scene += fmt::format("[[mesh]]\nname = '{}'\nfile = '{}.obj'\n", name, name);
        named.emplace_back(name + ".obj", file);
    }
    const double turn = 0.1 + view * 2 * 3.14159265358979 / kViews;
    const glm::dvec3 eye = onPlane(0, 0)
        + distance * glm::normalize(glm::dvec3(std::cos(turn), 0.9 * std::sin(3 * turn) + 0.3, std::sin(turn)));
    scene += cameraToml(eye, onPlane(0, 0), "fov = 45");
    const Picture picture = draw(makeConfig(R"(
        [image]
        size = [160, 120]
        [output]
        aovs = ["object_id"]
    )"),
        makeScene(scene, named));
    std::vector<int> ids;
    const Image& image = picture.aov("object_id");
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) ids.push_back(static_cast<int>(image.at(x, y)[0]));
    return ids;
}

TEST(Coincident, theFirstObjectWinsInEveryView) {
    for (int view = 0; view < kViews; ++view)
        for (const int id : objects({kGround, kDecal, sheet(2.5, 2.5, 1.1, 5, 2, false)}, view))
            ASSERT_TRUE(id == 0 || id == 1) << "object " << id << " in view " << view;
}

TEST(Coincident, theFirstObjectKeepsItsOutline) {
    for (int view = 0; view < kViews; ++view) {
        const auto decal = objects({kDecal}, view), both = objects({kDecal, kGround}, view),
                   ground = objects({kGround}, view);
        for (std::size_t i = 0; i < both.size(); ++i) {
            const int expected = decal[i] ? 1 : ground[i] ? 2 : 0;
            ASSERT_EQ(both[i], expected) << "pixel " << i << " of view " << view;
        }
    }
}

TEST(Coincident, ofTwoSheetsBackToBackTheOneThatFacesIsSeen) {
    int sides[2] = {};
    for (int view = 0; view < kViews; ++view) {
        const auto ids = objects({kGround, kBack}, view);
        std::set<int> seen(ids.begin(), ids.end());
        seen.erase(0);
        ASSERT_EQ(seen.size(), 1u) << "view " << view;
        ++sides[*seen.begin() - 1];
        // The order of files does not matter.
        const auto swapped = objects({kBack, kGround}, view);
        for (std::size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(swapped[i], ids[i] ? 3 - ids[i] : 0);
    }
    EXPECT_GT(sides[0], 5);
    EXPECT_GT(sides[1], 5);
}

TEST(Coincident, aBodyOnTheGroundHidesNothingOfItself) {
    const std::string box = boxObj({-1, 0, -1}, {1, 0.5, 1});
    const std::string floor = quadObj({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3});
    const auto normals = [&](bool withFloor) {
        std::string scene = "[[mesh]]\nname = 'box'\nfile = 'box.obj'\n";
        std::vector<std::pair<std::string, std::string>> files{{"box.obj", box}};
        if (withFloor) {
            scene += "[[mesh]]\nname = 'floor'\nfile = 'floor.obj'\n";
            files.emplace_back("floor.obj", floor);
        }
        scene += cameraToml({3.1, 2.2, 4.3}, {0, 0.2, 0}, "fov = 45");
        return draw(makeConfig(R"(
            [image]
            size = [640, 480]
            [output]
            aovs = ["object_id", "normal"]
        )"),
            makeScene(scene, files));
    };
    const Picture with = normals(true), without = normals(false);
    int differing = 0, compared = 0;
    for (int y = 0; y < 480; ++y)
        for (int x = 0; x < 640; ++x)
            if (with.aov("object_id").at(x, y)[0] == 1) {
                ++compared;
                differing += with.aov("normal").at(x, y)[1] != without.aov("normal").at(x, y)[1];
            }
    EXPECT_GT(compared, 10'000);
    EXPECT_EQ(differing, 0);
}

}  // namespace
}  // namespace limn::test
