// Lines from the mesh: as polylines, against projections by hand, and under changes that must not change them.

#include "base/file.h"
#include "drawing/drawing.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <tuple>

namespace limn::test {
namespace {

constexpr int kSize = 400;

/// The lines of a picture of 400 × 400 pixels.
std::vector<DrawnLine> linesOf(const LoadedScene& scene, const std::string& settings = "") {
    RenderConfig config = makeConfig(fmt::format(
        "[image]\nsize = [{}, {}]\nsamples = 1\n[[edges]]\ntechnique = 'mesh_lines'\n{}\n", kSize, kSize, settings));
    config.output.path = "drawing.svg";
    const Picture p = draw(config, scene);
    return p.frame.drawing->layers.front().lines;
}

LoadedScene sceneOf(const std::string& obj, const std::string& camera) {
    return makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + camera, {{"m.obj", obj}});
}

/// Several OBJ texts as one: vertices are numbered from the first.
std::string joined(const std::vector<std::string>& objs) {
    std::string all;
    int vertices = 0;
    for (std::size_t n = 0; n < objs.size(); ++n) {
        if (objs.size() > 1) all += fmt::format("o part{}\n", n);
        const int before = vertices;
        std::istringstream lines(objs[n]);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("v ")) ++vertices;
            if (!line.starts_with("f ")) {
                all += line + "\n";
                continue;
            }
            std::istringstream words(line.substr(2));
            all += "f";
            for (int number = 0; words >> number; words.ignore(64, ' '))
                all += fmt::format(" {}", number < 0 ? vertices + number + 1 : before + number);
            all += "\n";
        }
    }
    return all;
}

double lengthOf(const DrawnLine& line) {
    double length = 0;
    for (std::size_t i = 0; i + (line.isClosed ? 0 : 1) < line.points.size(); ++i)
        length += glm::distance(line.points[i].place, line.points[(i + 1) % line.points.size()].place);
    return length;
}

double visibleLength(const std::vector<DrawnLine>& lines, bool isVisible = true) {
    double length = 0;
    for (const auto& line : lines)
        if ((line.behind == 0) == isVisible) length += lengthOf(line);
    return length;
}

/// A parallel picture of 4 × 4 units: 100 pixels a unit.
const std::string kFront = cameraToml({0, 0, 10}, {0, 0, 0}, "orthographic_height = 4");
const glm::dvec3 kFrom(3, 2, 4);
const std::string kSlant = cameraToml(kFrom * 3.0, {0, 0, 0}, "orthographic_height = 4");

/// Length in pixels of a vector seen by kSlant.
double slanted(const glm::dvec3& v) {
    const glm::dvec3 to = glm::normalize(kFrom);
    return 100 * glm::length(v - to * glm::dot(v, to));
}

TEST(MeshLines, ofACubeAreItsNineVisibleEdgesAndThreeHidden) {
    const LoadedScene scene = sceneOf(boxObj(glm::dvec3(-0.5), glm::dvec3(0.5)), kSlant);
    const double edges = slanted({1, 0, 0}) + slanted({0, 1, 0}) + slanted({0, 0, 1});
    const auto visible = linesOf(scene);
    // Floats hold the places of vertices to 1e-7 of a unit, that is 1e-5 pixels.
    EXPECT_NEAR(visibleLength(visible), 3 * edges, 1e-3);
    const auto all = linesOf(scene, "hidden = 1");
    EXPECT_NEAR(visibleLength(all), 3 * edges, 1e-3);
    EXPECT_NEAR(visibleLength(all, false), edges, 1e-3);
    // The outline is one closed line of six edges.
    const auto outline = std::count_if(visible.begin(), visible.end(), [](const auto& line) {
        return line.isClosed && line.source == MeshLineSource::contours && line.points.size() == 6;
    });
    EXPECT_EQ(outline, 1);
}

TEST(MeshLines, areHiddenExactlyWhereSomethingLiesBefore) {
    // A card behind a narrower one that is turned by 30 degrees: what is left of its edges is known.
    const double turn = glm::radians(30.0), half = 0.3;
    const glm::dvec3 along(std::cos(turn), std::sin(turn), 0), across(-std::sin(turn), std::cos(turn), 0);
    const glm::dvec3 to(0, 0, 0.5);
    const LoadedScene scene = sceneOf(joined({quadObj({-1, -0.5, 0}, {1, -0.5, 0}, {1, 0.5, 0}, {-1, 0.5, 0}),
                                          quadObj(to - 1.5 * along - half * across, to + 1.5 * along - half * across,
                                              to + 1.5 * along + half * across, to - 1.5 * along + half * across)}),
        kFront);
    const auto lines = linesOf(scene, "hidden = 2");
    // The horizontal edges at y = ±0.5 lose 2 · half / sin 30° each; the vertical ones at x = ±1 the height between the
    // band's sides, 2 · half / cos 30°, as far as it lies within the edge.
    const auto cutOf = [&](double low, double high) {
        return std::max(0.0, std::min(high, 0.5) - std::max(low, -0.5));
    };
    const double middle = std::tan(turn), reach = half / std::cos(turn);
    const double lostUpright = cutOf(middle - reach, middle + reach) * 2;
    // Along the horizontal edges the band runs from (±0.5 ∓ half / cos) / tan.
    const auto atHeight = [&](double y, double side) { return (y - side * reach) / std::tan(turn); };
    const auto lostAt = [&](double y) { return std::min(1.0, atHeight(y, -1)) - std::max(-1.0, atHeight(y, 1)); };
    const double lost = 100 * (lostUpright + lostAt(0.5) + lostAt(-0.5));
    EXPECT_GT(lost, 100);
    EXPECT_NEAR(visibleLength(lines, false), lost, 1e-2);
    EXPECT_NEAR(visibleLength(lines), 100 * (2 * (2 + 1) + 2 * (3 + 2 * half)) - lost, 1e-2);
}

TEST(MeshLines, ofThingsThatTouchAreDrawnOnce) {
    // Boxes on a floor whose rim is left out. From the right, above and before: 6 edges along x of both boxes' tops and
    // fronts, 4 uprights and 4 along z, those between the boxes once.
    const std::string floor = quadObj({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}),
                      left = boxObj({-0.5, 0, -0.5}, {0.5, 1, 0.5}), right = boxObj({0.5, 0, -0.5}, {1.5, 1, 0.5});
    const double expected = 6 * slanted({1, 0, 0}) + 4 * slanted({0, 1, 0}) + 4 * slanted({0, 0, 1});
    const auto lengthFor = [&](const std::vector<std::string>& objs) {
        return visibleLength(linesOf(sceneOf(joined(objs), kSlant), "borders = 0"));
    };
    EXPECT_NEAR(lengthFor({left, right, floor}), expected, 0.1);
    EXPECT_NEAR(lengthFor({floor, right, left}), expected, 0.1);
    // One that is there twice, and a scene of which everything is.
    EXPECT_NEAR(lengthFor({left, right, left, floor}), expected, 0.1);
    EXPECT_NEAR(lengthFor({left, right, floor, left, right, floor}), expected, 0.1);
}

std::string torusObj(double radius, double thickness, int around, int across) {
    std::string obj;
    const double pi = std::acos(-1.0);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = radius + thickness * std::cos(v);
            obj += fmt::format("v {} {} {}\n", r * std::cos(u), thickness * std::sin(v), r * std::sin(u));
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const int a = i * across + j, b = i * across + (j + 1) % across,
                      c = (i + 1) % around * across + (j + 1) % across, d = (i + 1) % around * across + j;
            obj += fmt::format("f {} {} {} {}\n", a + 1, b + 1, c + 1, d + 1);
        }
    return obj;
}

/// 26 directions: faces, edges and corners of a cube, turned a little so that none is an axis of a mesh.
std::vector<glm::dvec3> directions() {
    std::vector<glm::dvec3> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) all.push_back(glm::normalize(glm::dvec3(x + 0.13, y + 0.07, z - 0.11)));
    return all;
}

/// A sphere with one vertex at each pole.
std::string ballObj(double radius, int sides) {
    const double pi = std::acos(-1.0);
    const int rings = sides / 2;
    std::string obj = fmt::format("v 0 {} 0\nv 0 {} 0\n", radius, -radius);
    for (int r = 1; r < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double theta = pi * r / rings, phi = 2 * pi * s / sides;
            obj += fmt::format("v {} {} {}\n", radius * std::sin(theta) * std::cos(phi), radius * std::cos(theta),
                -radius * std::sin(theta) * std::sin(phi));
        }
    const auto index = [&](int r, int s) { return r == 0 ? 1 : r == rings ? 2 : 3 + (r - 1) * sides + s % sides; };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            if (r > 0) obj += fmt::format("f {} {} {}\n", index(r, s), index(r + 1, s + 1), index(r, s + 1));
            if (r + 1 < rings) obj += fmt::format("f {} {} {}\n", index(r, s), index(r + 1, s), index(r + 1, s + 1));
        }
    return obj;
}

TEST(MeshLines, ofASphereAreOneCircle) {
    // The arc of one side rises 1 − cos(π / sides) of the radius over it, and twice that where both ways add up. A
    // coarse ball keeps its own outline; that of a fine one is the sphere's, to a fraction of that.
    const double radius = 150;
    for (const auto& [sides, beyond, within] : {std::tuple(24, 0.001, 2.57), std::tuple(96, 0.05, 0.16)}) {
        const std::string obj = ballObj(1.5, sides);
        for (const auto& to : directions()) {
            const auto lines = linesOf(sceneOf(obj, cameraToml(to * 10.0, {0, 0, 0}, "orthographic_height = 4")));
            ASSERT_EQ(lines.size(), 1u) << toml(to);
            EXPECT_TRUE(lines[0].isClosed) << toml(to);
            for (const auto& point : lines[0].points) {
                const double distance = glm::distance(point.place, glm::dvec2(kSize / 2));
                EXPECT_LE(distance, radius + beyond) << toml(to);
                EXPECT_GE(distance, radius - within) << toml(to);
            }
        }
    }
}

TEST(MeshLines, endInJunctionsAndCuspsOnly) {
    // A torus has an outline, and at most one more contour around its hole, which begins and ends in cusps or behind
    // the outline. Folds of the mesh beside its contour would make more.
    const std::string obj = torusObj(1.2, 0.5, 192, 96);
    std::size_t chains = 0;
    for (const auto& to : directions()) {
        const auto lines = linesOf(sceneOf(obj, cameraToml(to * 10.0, {0, 0, 0}, "orthographic_height = 4")));
        chains += lines.size();
        EXPECT_LE(lines.size(), 3u) << toml(to);
        for (const auto& line : lines) EXPECT_GT(lengthOf(line), 20) << toml(to);
    }
    EXPECT_GE(chains, 2 * directions().size() - 4);
}

double distanceTo(const std::vector<DrawnLine>& lines, const glm::dvec2& p) {
    double least = 1e9;
    for (const auto& line : lines)
        for (std::size_t i = 0; i + (line.isClosed ? 0 : 1) < line.points.size(); ++i) {
            const glm::dvec2 a = line.points[i].place, way = line.points[(i + 1) % line.points.size()].place - a;
            const double squared = glm::dot(way, way),
                         t = squared > 0 ? std::clamp(glm::dot(p - a, way) / squared, 0.0, 1.0) : 0;
            least = std::min(least, glm::distance(p, a + way * t));
        }
    return least;
}

/// The middles of the pixel sides where a mesh ends, from a picture 16 times as fine, in pixels of the coarse one.
std::vector<glm::dvec2> outlineOf(const LoadedScene& scene, int size) {
    constexpr int kFine = 16;
    const Picture p = draw(
        makeConfig(
            fmt::format("[image]\nsize = [{0}, {0}]\nsamples = 1\n[output]\naovs = ['object_id']\n", size * kFine)),
        scene);
    const Image& ids = p.aov("object_id");
    std::vector<glm::dvec2> sides;
    for (int y = 1; y < ids.height; ++y)
        for (int x = 1; x < ids.width; ++x) {
            const bool is = *ids.at(x, y) > 0;
            if (is != (*ids.at(x - 1, y) > 0)) sides.emplace_back(x, ids.height - y - 0.5);
            if (is != (*ids.at(x, y - 1) > 0)) sides.emplace_back(x + 0.5, ids.height - y);
        }
    for (auto& side : sides) side /= static_cast<double>(kFine);
    return sides;
}

// Limit surfaces beside their outlines in pictures 16 × 16 times as fine. Every camera with LIMN_ALL_CAMERAS=1.
TEST(MeshLines, ofSubdividedThingsAreTheirOutlines) {
    const char* data = std::getenv("LIMN_TEST_DATA");
    if (!data) GTEST_SKIP() << "LIMN_TEST_DATA names no folder";
    constexpr int kCoarse = 128;
    const auto all = directions();
    const std::size_t step = std::getenv("LIMN_ALL_CAMERAS") ? 1 : 9;
    std::size_t chains = 0, slivers = 0, points = 0, off = 0;
    double worst = 0;
    for (const auto* file : {"cages/spot_control_mesh", "cages/penguin_control_mesh", "cages/fish_control_mesh",
             "osd_shapes/catmark_pawn", "osd_shapes/catmark_bishop", "osd_shapes/catmark_torus",
             "osd_shapes/catmark_toroidal_tet", "osd_shapes/catmark_cube_creases0"}) {
        const std::string path = fmt::format("{}/{}.obj", data, file);
        if (!std::ifstream(path)) continue;
        for (std::size_t i = 0; i < all.size(); i += step) {
            const LoadedScene bare = loadScene(path, {.subdivide = 5});
            const Bounds box = bare.bounds;
            const LoadedScene scene = makeScene(
                fmt::format(
                    "[[mesh]]\nname = 'm'\nfile = '{}'\nsubdivision = {{ edge_length = '1px', level = 6 }}\n", path)
                    + cameraToml(box.centre() + all[i] * box.diagonal() * 3.0, box.centre(),
                        fmt::format("orthographic_height = {}", box.diagonal() * 1.1)),
                {});
            RenderConfig config = makeConfig(
                fmt::format("[image]\nsize = [{0}, {0}]\nsamples = 1\n[[edges]]\ntechnique = 'mesh_lines'\n", kCoarse));
            config.output.path = "drawing.svg";
            const auto lines = draw(config, scene).frame.drawing->layers.front().lines;
            for (const auto& p : outlineOf(scene, kCoarse)) {
                const double distance = distanceTo(lines, p);
                worst = std::max(worst, distance);
                ++points;
                off += distance > 0.3;
            }
            for (const auto& line : lines) {
                if (line.source != MeshLineSource::contours) continue;
                ++chains;
                slivers += !line.isClosed && lengthOf(line) < 2;
            }
        }
    }
    fmt::print(
        "{} points of outlines: the farthest {:.3f} pixels from a line, {} beyond 0.3; {} contours, {} shorter "
        "than 2 pixels\n",
        points, worst, off, chains, slivers);
    EXPECT_GT(points, 10000u);
    // Facets as large as a pixel: what is bridged or left out of their folds costs up to 0.7 of one, and seldom.
    EXPECT_LE(worst, 0.7);
    EXPECT_LE(static_cast<double>(off), 3e-4 * static_cast<double>(points));
    EXPECT_LE(static_cast<double>(slivers), 0.15 * static_cast<double>(chains));
}

/// The same lines, whatever their order and where closed ones begin: sorted texts of rounded places.
std::vector<std::string> fingerprint(const std::vector<DrawnLine>& lines) {
    std::vector<std::string> all;
    for (const auto& line : lines)
        for (std::size_t i = 0; i + (line.isClosed ? 0 : 1) < line.points.size(); ++i) {
            const auto text = [](const glm::dvec2& p) { return fmt::format("{:.2f},{:.2f}", p.x + 1e-4, p.y + 1e-4); };
            std::string a = text(line.points[i].place), b = text(line.points[(i + 1) % line.points.size()].place);
            if (b < a) std::swap(a, b);
            if (a != b) all.push_back(a + " " + b);
        }
    std::sort(all.begin(), all.end());
    return all;
}

TEST(MeshLines, areTheSameAtAnyScale) {
    const std::string camera = "[[camera]]\nposition = {}\nlook_at = {}\nfov = 40\n";
    const glm::dvec3 eye(4, 3, 6);
    const auto at = [&](double scale) {
        return linesOf(sceneOf(
            mixedObj(glm::dvec3(0), scale), fmt::format(fmt::runtime(camera), toml(eye * scale), toml(glm::dvec3(0)))));
    };
    const auto one = at(1);
    EXPECT_GT(one.size(), 20u);
    for (const double scale : {std::ldexp(1.0, 40), std::ldexp(1.0, -40)}) {
        const auto other = at(scale);
        ASSERT_EQ(one.size(), other.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            ASSERT_EQ(one[i].points.size(), other[i].points.size());
            for (std::size_t k = 0; k < one[i].points.size(); ++k)
                EXPECT_EQ(one[i].points[k].place, other[i].points[k].place);
        }
    }
}

TEST(MeshLines, doNotDependOnTheOrderOfTriangles) {
    const std::string obj = joined({mixedObj()});
    std::vector<std::string> vertices, faces;
    std::istringstream lines(obj);
    for (std::string line; std::getline(lines, line);) (line.starts_with("f ") ? faces : vertices).push_back(line);
    std::mt19937 random(5);
    std::shuffle(faces.begin(), faces.end(), random);
    std::string shuffled;
    for (const auto& line : vertices) shuffled += line + "\n";
    for (const auto& line : faces) shuffled += line + "\n";
    const std::string camera = cameraToml({4, 3, 6}, {0, 0, 0}, "fov = 40");
    const auto one = linesOf(sceneOf(obj, camera), "objects = 0\nmaterials = 0"),
               other = linesOf(sceneOf(shuffled, camera), "objects = 0\nmaterials = 0");
    EXPECT_NEAR(visibleLength(one), visibleLength(other), 0.01);
    EXPECT_EQ(fingerprint(one), fingerprint(other));
}

TEST(MeshLines, ofIntersectionsLieOnBothSurfaces) {
    // A ball of radius 1 in a floor at a third of its height: a circle, seen from above.
    const LoadedScene scene = sceneOf(
        joined({sphereObj(1, 96), quadObj({-1.8, 0.3, 1.8}, {1.8, 0.3, 1.8}, {1.8, 0.3, -1.8}, {-1.8, 0.3, -1.8})}),
        cameraToml({0, 10, 0}, {0, 0, 0}, "orthographic_height = 4", {0, 0, -1}));
    const auto lines = linesOf(scene);
    const double radius = 100 * std::sqrt(1 - 0.3 * 0.3);
    double length = 0;
    for (const auto& line : lines) {
        if (line.source != MeshLineSource::intersections) continue;
        EXPECT_TRUE(line.isClosed);
        length += lengthOf(line);
        for (const auto& point : line.points) {
            const double distance = glm::distance(point.place, glm::dvec2(kSize / 2));
            EXPECT_LE(distance, radius + 0.01);
            EXPECT_GE(distance, radius - 0.4) << "the facets' depth, seen at this slope";
        }
    }
    EXPECT_NEAR(length, 2 * std::acos(-1.0) * radius, 2);
    for (const auto& line : linesOf(scene, "intersections = 0")) EXPECT_NE(line.source, MeshLineSource::intersections);
}

TEST(MeshLines, ofWhatLiesBeforeTheNearestPlaneAreNotThere) {
    const std::string behind = boxObj({-0.5, -0.5, 11}, {0.5, 0.5, 12}), seen = boxObj({-0.5, -0.5, -1}, {0.5, 0.5, 0});
    EXPECT_TRUE(linesOf(sceneOf(behind, kFront)).empty());
    // Nor does it hide anything; and of what the plane cuts, the part beyond it does.
    const double alone = visibleLength(linesOf(sceneOf(seen, kFront)));
    EXPECT_NEAR(alone, 400, 1e-3);
    EXPECT_NEAR(visibleLength(linesOf(sceneOf(joined({behind, seen}), kFront))), alone, 1e-3);
    const std::string near = kFront + "near = 5\n";
    const std::string wall = quadObj({0, -2, 9}, {0, 2, 9}, {0.3, 2, 1}, {0.3, -2, 1});
    double behindWall = 0;
    for (const auto& line : linesOf(sceneOf(joined({seen, wall}), near)))
        if (line.part == 0) behindWall += lengthOf(line);
    // Seen from before, the wall spans x from 0 to 0.3; its nearer half, up to x = 0.15, is cut off.
    EXPECT_NEAR(behindWall, 400 - 2 * 15, 0.5);
}

TEST(MeshLines, areSeenThroughHoles) {
    // A card, and before it one of twice its size, whose lower half is a hole: what shows is what lies there.
    TemporaryFolder folder;
    Image half{64, 64, 4, std::vector<float>(std::size_t{64} * 64 * 4, 1.0f)};
    for (int y = 32; y < 64; ++y)
        for (int x = 0; x < 64; ++x) std::fill_n(half.at(x, y), 4, 0.0f);
    const Layer layer{"beauty", {"R", "G", "B", "A"}, true, false, half};
    const auto path = folder.path() / "half.png";
    replaceFile(path, encodeImage(*imageFormat(path), {&layer, 1}, {}, {}));
    const std::string front =
        "v -1.6 -1.6 1\nv 1.6 -1.6 1\nv 1.6 1.6 1\nv -1.6 1.6 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "usemtl half\nf 1/1 2/2 3/3 4/4\n";
    const std::string scene = "[[mesh]]\nname = 'a'\nfile = 'a.obj'\n[[mesh]]\nname = 'b'\nfile = 'b.obj'\n"
        + fmt::format("[[material]]\nname = 'half'\ncutout = '{}'\n", path.string())
        + "[[instance]]\nmesh = 'a'\n[[instance]]\nmesh = 'b'\nmaterial = 'half'\n" + kFront;
    const LoadedScene both = makeScene(
        scene, {{"a.obj", quadObj({-0.8, -0.8, 0}, {0.8, -0.8, 0}, {0.8, 0.8, 0}, {-0.8, 0.8, 0})}, {"b.obj", front}});
    // 1.6 of its lower edge and 0.8 of each side; alpha is one half where the texels meet, at the middle.
    double length = 0;
    for (const auto& line : linesOf(both))
        if (line.instance == 0) length += lengthOf(line);
    EXPECT_NEAR(length, 160 + 2 * 80, 0.5);
}

TEST(MeshLines, ofDashesBeginAndEndWithOne) {
    DrawnLine line;
    line.points = {{{0, 0}, 1}, {{100, 0}, 1}, {{100, 37}, 1}};
    const auto dashes = dashesOf(line, {6, 4});
    // 100 = n · 6 + (n − 1) · 4 at n = 10.4: ten dashes, 104/100 too long; 37: four.
    ASSERT_EQ(dashes.size(), 14u);
    const auto end = [&](std::size_t i) { return dashes[i].back().place; };
    EXPECT_NEAR(glm::distance(end(9), {100, 0}), 0, 1e-9);
    EXPECT_NEAR(glm::distance(dashes[10].front().place, {100, 0}), 0, 1e-9);
    EXPECT_NEAR(glm::distance(end(13), {100, 37}), 0, 1e-9);
    EXPECT_NEAR(end(0).x, 6 * 100.0 / 96, 1e-9);
    EXPECT_NEAR(dashes[1].front().place.x, 10 * 100.0 / 96, 1e-9);
}

}  // namespace
}  // namespace limn::test
