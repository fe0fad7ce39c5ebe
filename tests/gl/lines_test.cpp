// Lines against edges that are known: of boxes, projected by hand, with hidden parts removed by rays that know nothing
// of the renderer.
//
// With LIMN_LINE_SCENES=FOLDER the scenes are left there for another renderer, and a picture NAME.other.png of black
// lines on white that it has put there is measured in the same way (tests/bench/freestyle.sh).

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace limn::test {
namespace {

struct Box {
    glm::dvec3 lo, hi;
};

struct Eye {
    glm::dvec3 position, lookAt;
    double fov = 0;     ///< degrees, horizontal; 0: parallel
    double height = 0;  ///< of a parallel picture
};

constexpr int kWidth = 640, kHeight = 480;

/// A camera of the test's own: pixels from the upper left, and the direction in which a point is seen.
struct Projection {
    explicit Projection(const Eye& eye) : eye_(eye) {
        back_ = glm::normalize(eye.position - eye.lookAt);
        right_ = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back_));
        up_ = glm::cross(back_, right_);
        scale_ = eye.fov > 0 ? kWidth / (2 * std::tan(glm::radians(eye.fov) / 2)) : kHeight / eye.height;
    }
    glm::dvec2 pixel(const glm::dvec3& p) const {
        const glm::dvec3 d = p - eye_.position;
        const double depth = eye_.fov > 0 ? -glm::dot(d, back_) : 1;
        return {kWidth / 2.0 + glm::dot(d, right_) / depth * scale_, kHeight / 2.0 - glm::dot(d, up_) / depth * scale_};
    }
    bool isBehind(const glm::dvec3& p) const { return glm::dot(p - eye_.position, back_) >= -1e-3; }
    /// Unit vector from a point to where it is seen from.
    glm::dvec3 toEye(const glm::dvec3& p) const { return eye_.fov > 0 ? glm::normalize(eye_.position - p) : back_; }
    double distance(const glm::dvec3& p) const { return eye_.fov > 0 ? glm::length(eye_.position - p) : 1e6; }

private:
    Eye eye_;
    glm::dvec3 back_, right_, up_;
    double scale_;
};

/// Does the ray p + t·d, 0 < t < end, pass through the box's inside?
bool blocks(const Box& box, const glm::dvec3& p, const glm::dvec3& d, double end) {
    double in = 1e-9, out = end;
    for (int axis = 0; axis < 3; ++axis) {
        const double shrink = 1e-9, lo = box.lo[axis] + shrink, hi = box.hi[axis] - shrink;
        if (d[axis] == 0) {
            if (p[axis] <= lo || p[axis] >= hi) return false;
            continue;
        }
        const double a = (lo - p[axis]) / d[axis], b = (hi - p[axis]) / d[axis];
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
    }
    return out - in > 1e-7;
}

/// Points every quarter of a pixel along what is seen of the boxes' edges.
std::vector<glm::dvec2> trueEdges(const std::vector<Box>& boxes, const Projection& camera) {
    std::vector<glm::dvec2> points;
    for (const Box& box : boxes)
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 4; ++side) {
                const int one = (axis + 1) % 3, other = (axis + 2) % 3;
                glm::dvec3 from, normalOne(0), normalOther(0);
                from[axis] = box.lo[axis];
                from[one] = side & 1 ? box.hi[one] : box.lo[one];
                normalOne[one] = side & 1 ? 1 : -1;
                from[other] = side & 2 ? box.hi[other] : box.lo[other];
                normalOther[other] = side & 2 ? 1 : -1;
                glm::dvec3 to = from;
                to[axis] = box.hi[axis];
                if (camera.isBehind(from) || camera.isBehind(to)) {
                    // The part before the eye: enough of it lies in the picture.
                    if (camera.isBehind(from)) std::swap(from, to);
                    if (camera.isBehind(from)) continue;
                    double low = 0, high = 1;
                    for (int i = 0; i < 40; ++i)
                        (camera.isBehind(glm::mix(from, to, (low + high) / 2)) ? high : low) = (low + high) / 2;
                    to = glm::mix(from, to, low * 0.999);
                }
                const auto steps =
                    static_cast<int>(std::min(4e4, std::ceil(glm::length(camera.pixel(to) - camera.pixel(from)) * 4)))
                    + 1;
                for (int i = 0; i <= steps; ++i) {
                    // Evenly over the line's length; the picture of a receding one bunches its far end.
                    const glm::dvec3 p = glm::mix(from, to, (i + 0.5) / (steps + 1));
                    const glm::dvec3 d = camera.toEye(p);
                    // Somebody sees the edge who sees a face of it.
                    if (glm::dot(normalOne, d) <= 1e-6 && glm::dot(normalOther, d) <= 1e-6) continue;
                    bool hidden = false;
                    for (const Box& blocker : boxes) hidden = hidden || blocks(blocker, p, d, camera.distance(p));
                    const glm::dvec2 at = camera.pixel(p);
                    if (!hidden && at.x > 3 && at.y > 3 && at.x < kWidth - 3 && at.y < kHeight - 3)
                        points.push_back(at);
                }
            }
    return points;
}

struct Score {
    double drawn = 0;  ///< of the true length, what has a line within a pixel
    double false_ =
        0;  ///< of the ink, what lies farther than a pixel beside the line's own half width from any true edge
};

Score measure(const std::vector<glm::dvec2>& edges, const std::vector<float>& ink, double width) {
    const auto inkAt = [&](int x, int y) {
        return x < 0 || y < 0 || x >= kWidth || y >= kHeight
            ? 0.0
            : static_cast<double>(ink[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]);
    };
    std::vector<char> nearEdge(kWidth * kHeight);
    Score score;
    const double reach = 1 + width / 2 + 0.71;  // ink reaches half a pixel's diagonal beyond the line
    for (const auto& p : edges) {
        double most = 0;
        for (int y = static_cast<int>(p.y) - 3; y <= p.y + 3; ++y)
            for (int x = static_cast<int>(p.x) - 3; x <= p.x + 3; ++x) {
                const double distance = std::hypot(x + 0.5 - p.x, y + 0.5 - p.y);
                if (distance <= 1) most = std::max(most, inkAt(x, y));
                if (distance <= reach && x >= 0 && y >= 0 && x < kWidth && y < kHeight)
                    nearEdge[static_cast<std::size_t>(y * kWidth + x)] = true;
            }
        score.drawn += most >= 0.3;
    }
    double all = 0, wrong = 0;
    for (int y = 4; y < kHeight - 4; ++y)
        for (int x = 4; x < kWidth - 4; ++x) {
            all += inkAt(x, y);
            wrong += nearEdge[static_cast<std::size_t>(y * kWidth + x)] ? 0 : inkAt(x, y);
        }
    score.drawn /= static_cast<double>(edges.size());
    score.false_ = all > 0 ? wrong / all : 1;
    return score;
}

struct LineScene {
    const char* name;
    std::vector<Box> boxes;
    Eye eye;
};

std::vector<LineScene> lineScenes() {
    std::vector<LineScene> scenes;
    // A floor seen at two degrees, with things on it near and far.
    LineScene grazing{"grazing_floor", {{{-30, -0.2, -60}, {30, 0, 4}}}, {{0, 0.8, 6}, {0, 0.35, -6}, 55, 0}};
    for (int i = 0; i < 9; ++i)
        grazing.boxes.push_back(
            {{-4.6 + 1.1 * i, 0, -3.0 - 2.3 * i}, {-4.0 + 1.1 * i, 0.5 + 0.12 * i, -2.5 - 2.3 * i}});
    scenes.push_back(grazing);
    // Railings: bars two and three pixels thick, standing free, before a wall and before nothing.
    LineScene railing{"thin_railing", {{{-6, -0.1, -4}, {6, 0, 3}}, {{-6, 0, -4}, {1.5, 2.2, -3.8}}},
        {{2.2, 1.7, 5.5}, {0.2, 0.7, 0}, 50, 0}};
    for (int i = 0; i < 24; ++i) railing.boxes.push_back({{-2.9 + 0.25 * i, 0, 0}, {-2.88 + 0.25 * i, 1.0, 0.02}});
    railing.boxes.push_back({{-2.95, 1.0, -0.02}, {2.95, 1.05, 0.04}});
    scenes.push_back(railing);
    // An elevation: panels a few millimetres to a few centimetres proud of a wall, at about a centimetre per pixel.
    LineScene steps{"coplanar_steps", {{{-3, 0, -0.3}, {3, 4, 0}}}, {{0, 2, 10}, {0, 2, 0}, 0, 4.4}};
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 3; ++j)
            steps.boxes.push_back({{-2.7 + 1.13 * i, 0.35 + 1.22 * j, 0},
                {-1.9 + 1.13 * i, 1.2 + 1.22 * j, 0.006 + 0.004 * (3 * i + j)}});
    scenes.push_back(steps);
    // The same wall, at a slant.
    LineScene slant = steps;
    slant.name = "coplanar_steps_aslant";
    slant.eye = {{5.5, 3.1, 5.2}, {0.1, 1.9, 0}, 40, 0};
    scenes.push_back(slant);
    // A room of walls, shelves and furniture.
    LineScene room{"room", {{{-3, -0.1, -3}, {3, 0, 3}}, {{-3.1, 0, -3}, {-3, 2.6, 3}}, {{-3, 0, -3.1}, {3, 2.6, -3}}},
        {{2.4, 1.6, 3.6}, {-0.5, 0.9, -1}, 62, 0}};
    for (int i = 0; i < 5; ++i) room.boxes.push_back({{-1.2, 0.3 + 0.4 * i, -2.98}, {0.9, 0.33 + 0.4 * i, -2.7}});
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            room.boxes.push_back({{-0.6 + 1.3 * i, 0, -0.9 + 0.7 * j}, {-0.54 + 1.3 * i, 0.7, -0.84 + 0.7 * j}});
    room.boxes.push_back({{-0.7, 0.7, -1.0}, {0.86, 0.74, 0.0}});
    room.boxes.push_back({{-2.4, 0, 0.2}, {-1.5, 0.45, 1.7}});
    room.boxes.push_back({{-2.4, 0.46, 0.2}, {-2.2, 0.9, 1.7}});
    scenes.push_back(room);
    return scenes;
}

/// The scene's boxes as an OBJ, an object each.
std::string objOf(const LineScene& scene) {
    std::string obj;
    int vertex = 0;
    for (const auto& box : scene.boxes) {
        obj += fmt::format("o box{}\n", vertex / 8);
        for (int i = 0; i < 8; ++i)
            obj += fmt::format(
                "v {} {} {}\n", i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z);
        for (const auto& q :
            {std::array{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}})
            obj += fmt::format("f {} {} {} {}\n", vertex + q[0], vertex + q[1], vertex + q[2], vertex + q[3]);
        vertex += 8;
    }
    return obj;
}

std::vector<float> inkOf(const LineScene& scene, const std::string& technique, int samples) {
    const Eye& eye = scene.eye;
    const std::string lens =
        eye.fov > 0 ? fmt::format("fov = {}", eye.fov) : fmt::format("orthographic_height = {}", eye.height);
    const Picture p = draw(makeConfig(fmt::format("[image]\nsize = [{}, {}]\nsamples = {}\n[[edges]]\ntechnique = "
                                                  "'{}'\nwidth = '1px'\n[output]\naovs = ['edges']\n",
                               kWidth, kHeight, samples, technique)),
        makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml(eye.position, eye.lookAt, lens),
            {{"m.obj", objOf(scene)}}));
    std::vector<float> ink;
    for (std::size_t i = 3; i < p.aov("edges").pixels.size(); i += 4) ink.push_back(p.aov("edges").pixels[i]);
    return ink;
}

/// Leaves the scene for another renderer, and measures the picture that it has put there.
void compareWithOther(const LineScene& scene, const std::vector<glm::dvec2>& edges, const char* folder) {
    const Eye& eye = scene.eye;
    const std::string base = fmt::format("{}/{}", folder, scene.name);
    std::ofstream(base + ".obj") << objOf(scene);
    std::ofstream(base + ".camera") << fmt::format("{} {} {} {} {} {} {} {} {} {}\n", eye.position.x, eye.position.y,
        eye.position.z, eye.lookAt.x, eye.lookAt.y, eye.lookAt.z, eye.fov, eye.height, kWidth, kHeight);
    if (!std::ifstream(base + ".other.png")) return;
    const Image other = readImage(base + ".other.png");
    std::vector<float> ink(other.pixels.size() / static_cast<std::size_t>(other.channels));
    for (std::size_t i = 0; i < ink.size(); ++i)
        ink[i] = 1 - other.pixels[i * static_cast<std::size_t>(other.channels)];
    const Score theirs = measure(edges, ink, 1);
    fmt::print("{:<24}{:>9.2f}%{:>9.2f}%\n", "  the other renderer", 100 * theirs.drawn, 100 * theirs.false_);
}

TEST(Lines, areWhereTheEdgesAreAndNowhereElse) {
    const char* folder = std::getenv("LIMN_LINE_SCENES");
    fmt::print("{:<24}{:>10}{:>10}\n", "", "drawn", "false");
    for (const auto& scene : lineScenes()) {
        const auto edges = trueEdges(scene.boxes, Projection(scene.eye));
        EXPECT_GT(edges.size(), 4000u) << scene.name;
        const Score image = measure(edges, inkOf(scene, "depth_normal", 4), 1);
        fmt::print("{:<24}{:>9.2f}%{:>9.2f}%\n", scene.name, 100 * image.drawn, 100 * image.false_);
        EXPECT_GE(image.drawn, 0.99) << scene.name;
        EXPECT_LE(image.false_, 0.005) << scene.name;
        const Score mesh = measure(edges, inkOf(scene, "mesh_lines", 1), 1);
        fmt::print("{:<24}{:>9.2f}%{:>9.2f}%\n", "  from the mesh", 100 * mesh.drawn, 100 * mesh.false_);
        EXPECT_GE(mesh.drawn, 0.999) << scene.name;
        EXPECT_LE(mesh.false_, 0.001) << scene.name;
        if (folder) compareWithOther(scene, edges, folder);
    }
}

TEST(Lines, ofATurningEdgeShowNoSteps) {
    // One straight edge, turned by small angles: along it, the ink of each row (or column) has its middle on the edge
    // and the same weight.
    for (const double degrees : {0.3, 1.7, 5.0, 11.3, 22.5, 33.0, 44.9, 45.0, 63.4, 88.6})
        for (const int samples : {1, 4}) {
            const LoadedScene scene =
                makeScene(fmt::format("[[mesh]]\nname = 'q'\nfile = 'q.obj'\n[[camera]]\nposition = [0, 0, 5]\nlook_at "
                                      "= [0, 0, 0]\northographic_height = 2\n[[instance]]\nmesh = 'q'\nrotate = [0, 0, "
                                      "{}]\ntranslate = [0.0037, 0.0021, 0]\n",
                              degrees),
                    {{"q.obj", "v 0 -9 0\nv 18 -9 0\nv 18 9 0\nv 0 9 0\nf 1 2 3 4\n"}});
            constexpr int size = 160;
            const Picture p =
                draw(makeConfig(fmt::format("[image]\nsize = [{}, {}]\nsamples = {}\n[[edges]]\ntechnique = "
                                            "'depth_normal'\nwidth = '1.5px'\n[output]\naovs = ['edges']\n",
                         size, size, samples)),
                    scene);
            const double angle = glm::radians(degrees), c = std::cos(angle), s = std::sin(angle);
            const bool steep = c >= s;  // the edge runs closer to the vertical: rows cross it
            double meanWeight = 0;
            std::vector<double> weights;
            for (int i = 24; i < size - 24; ++i) {
                double sum = 0, moment = 0;
                for (int j = 0; j < size; ++j) {
                    const double alpha = static_cast<double>(p.aov("edges").at(steep ? j : i, steep ? i : j)[3]);
                    sum += alpha;
                    moment += alpha * (j + 0.5);
                }
                if (sum < 0.1) continue;
                // The edge: through the centre (moved by the translation), along (−sin, cos), y up.
                const double scale = size / 2.0, cx = size / 2.0 + 0.0037 * scale, cy = size / 2.0 - 0.0021 * scale;
                const double expected = steep ? cx + (i + 0.5 - cy) * (s / c) : cy + (i + 0.5 - cx) * (c / s);
                if (expected < 6 || expected > size - 6) continue;
                EXPECT_NEAR(moment / sum, expected, 0.125)
                    << degrees << " degrees, row " << i << ", " << samples << " samples";
                weights.push_back(sum);
                meanWeight += sum;
            }
            ASSERT_GT(weights.size(), 40u) << degrees;
            meanWeight /= static_cast<double>(weights.size());
            EXPECT_NEAR(meanWeight * (steep ? c : s), 1.5, 1.5 * 0.02) << degrees;
            for (const double weight : weights)
                EXPECT_NEAR(weight, meanWeight, 0.05 * meanWeight) << degrees << " degrees, " << samples << " samples";
        }
}

TEST(Lines, ofLongThinFacesAreStraight) {
    // Near its ends the diagonal of a long face lies within a pixel of its edge: between them lies a triangle that no
    // pixel's centre sees.
    for (const double degrees : {0.0, 0.4, 3.0, 17.0, 40.0})
        for (const bool flipped : {false, true}) {
            const LoadedScene scene =
                makeScene(fmt::format("[[mesh]]\nname = 'q'\nfile = 'q.obj'\n[[camera]]\nposition = [0, 0, 5]\nlook_at "
                                      "= [0, 0, 0]\northographic_height = 2\n[[instance]]\nmesh = 'q'\nrotate = [0, 0, "
                                      "{}]\nscale = [{}, 1, 1]\ntranslate = [0.0037, 0.0021, 0]\n",
                              degrees, flipped ? -1 : 1),
                    {{"q.obj", "v -0.06 -0.85 0\nv 0.06 -0.85 0\nv 0.06 0.85 0\nv -0.06 0.85 0\nf 1 2 3 4\n"}});
            constexpr int size = 240;
            const Picture p =
                draw(makeConfig(fmt::format("[image]\nsize = [{}, {}]\nsamples = 1\n[[edges]]\ntechnique = "
                                            "'depth_normal'\nwidth = '1.5px'\n[output]\naovs = ['edges']\n",
                         size, size)),
                    scene);
            const double angle = glm::radians(degrees), c = std::cos(angle), s = std::sin(angle), scale = size / 2.0;
            int rows = 0;
            for (const double side : {-0.06, 0.06})
                for (int y = 0; y < size; ++y) {
                    // Along the long edge, from end to end, but for what the short edges cover.
                    const double up = (size / 2.0 - (y + 0.5)) / scale - 0.0021, along = (up - side * s) / c;
                    if (std::abs(along) > 0.85 - 14 / scale) continue;
                    const double expected = size / 2.0 + (0.0037 + side * c - along * s) * scale;
                    double sum = 0, moment = 0;
                    for (int x = static_cast<int>(expected) - 4; x <= expected + 4; ++x) {
                        const double alpha = static_cast<double>(p.aov("edges").at(x, y)[3]);
                        sum += alpha;
                        moment += alpha * (x + 0.5);
                    }
                    EXPECT_NEAR(moment / sum, expected, 0.125) << degrees << " degrees, row " << y;
                    EXPECT_NEAR(sum * c, 1.5, 0.075) << degrees << " degrees, row " << y;
                    ++rows;
                }
            EXPECT_GT(rows, 240);
        }
}

TEST(Lines, areAsWideInMillimetresAtEveryResolution) {
    // Straight, curved and crossing lines at 1, 2 and 4 times the resolution, and supersampled: ink over length is the
    // same width on paper.
    const LoadedScene curved = makeScene(
        "[[mesh]]\nname = 's'\nfile = 's.obj'\n" + cameraToml({0, 0, 9}, {0, 0, 0}, "orthographic_height = 3"),
        {{"s.obj", sphereObj(1, 256)}});
    const std::string ring =
        "o a\nv -1.2 -0.05 0\nv 1.2 -0.05 0\nv 1.2 0.05 0\nv -1.2 0.05 0\nf 1 2 3 4\no b\nv -0.05 -1.2 0.3\nv 0.05 "
        "-1.2 0.3\nv 0.05 1.2 0.3\nv -0.05 1.2 0.3\nf 5 6 7 8\n";
    const LoadedScene crossing =
        makeScene("[[mesh]]\nname = 'c'\nfile = 'c.obj'\n[[instance]]\nmesh = 'c'\nrotate = [0, 0, 27]\n"
                + cameraToml({0, 0, 9}, {0, 0, 0}, "orthographic_height = 3"),
            {{"c.obj", ring}});
    const double pi = std::acos(-1.0);
    for (const auto& [scene, length, name] :
        {std::tuple{&curved, 2 * pi, "curved"}, std::tuple{&crossing, 2 * (2 * 2.4 + 2 * 0.1) - 2 * 0.1, "crossing"}}) {
        double first = 0;
        for (const int times : {1, 2, 4})
            for (const int samples : {1, 4, 16}) {
                const Picture p = draw(
                    makeConfig(fmt::format("[image]\nsize = [{}, {}]\ndpi = {}\nsamples = {}\n[[edges]]\ntechnique = "
                                           "'depth_normal'\nwidth = '0.4mm'\ncreases = 0\n[output]\naovs = ['edges']\n",
                        120 * times, 120 * times, 100 * times, samples)),
                    *scene);
                double ink = 0;
                for (std::size_t i = 3; i < p.aov("edges").pixels.size(); i += 4)
                    ink += static_cast<double>(p.aov("edges").pixels[i]);
                const double pixelsPerUnit = 40.0 * times,
                             width = ink / (length * pixelsPerUnit) / (100 * times) * 25.4;
                if (first == 0) first = width;
                EXPECT_NEAR(width, first, 0.03 * first)
                    << name << " at " << times << " times, " << samples << " samples";
                // Corners and crossings cover a little twice or not at all; along a circle of 40 pixels triangles are
                // smaller than pixels, and the line trembles by some hundredths of one.
                EXPECT_NEAR(width, 0.4, 0.4 * 0.06) << name << " at " << times << " times, " << samples << " samples";
            }
    }
}

}  // namespace
}  // namespace limn::test
