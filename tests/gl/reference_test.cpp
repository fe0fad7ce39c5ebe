// The ray tracer against scenes whose ambient occlusion is known, and against another renderer's pictures.

#include "image/image.h"
#include "settings/color.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

namespace limn::test {
namespace {

const double kPi = std::acos(-1.0);

/// Cosine-weighted share of the hemisphere around z for which `hit`: the area of the unit disk under it.
double hiddenShare(const std::function<bool(const glm::dvec3&)>& hit) {
    constexpr int n = 1200;
    int inside = 0, hits = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = (i + 0.5) * 2 / n - 1, y = (j + 0.5) * 2 / n - 1, r2 = x * x + y * y;
            if (r2 >= 1) continue;
            ++inside;
            hits += hit({x, y, std::sqrt(1 - r2)});
        }
    return static_cast<double>(hits) / inside;
}

std::string settings(double radius, int rays, const std::string& more = "") {
    return fmt::format(
        "shading = 'flat'\n[image]\nsize = [96, 64]\nsamples = 1\n[ao]\ntechnique = 'ray_traced'\nradius = {}\nrays = "
        "{}\n{}[output]\naovs = ['ambient_occlusion_raw', 'ambient_occlusion_error', 'position', 'normal_geometric']\n",
        radius, rays, more);
}

/// Compares every pixel whose position `truth` has an answer for.
void compare(const Picture& picture, const std::function<double(const glm::dvec3&)>& truth, int atLeast) {
    const Image &ao = picture.aov("ambient_occlusion_raw"), &error = picture.aov("ambient_occlusion_error"),
                &position = picture.aov("position");
    double sum = 0, squares = 0, expected = 0;
    int count = 0;
    for (int y = 0; y < ao.height; ++y)
        for (int x = 0; x < ao.width; ++x) {
            const float* p = position.at(x, y);
            const double wanted = truth({p[0], p[1], p[2]});
            if (wanted < 0) continue;
            const double difference = *ao.at(x, y) - wanted;
            // 1e-3: the grid of hiddenShare. Five standard errors: six thousand pixels, none of which may fail by
            // chance. One hit of 1024 rays: groups of rays may all have as many hits, which are none too exact.
            EXPECT_LE(std::abs(difference), 5 * *error.at(x, y) + 1e-3 + 1.0 / 1024) << x << ", " << y;
            sum += difference;
            squares += difference * difference;
            expected += double(*error.at(x, y)) * *error.at(x, y);
            ++count;
        }
    EXPECT_GE(count, atLeast);
    // The pixels of a wedge lie in one row or two, which have four pixels' rays each: 4096 rays find a half-space
    // within 0.0023 (40 places, each row of a tile), and the grid is as good as above.
    EXPECT_LE(std::abs(sum / count), 3.3e-3);
    // The estimate of the error is no excuse and no boast: rays are spread more evenly than groups of them, by up to a
    // factor of 4 measured.
    EXPECT_LE(std::sqrt(squares / count), 1.2 * std::sqrt(expected / count) + 5e-4);
}

TEST(Reference, itsErrorCanBeAskedForAlone) {
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[camera]]\nposition = [3, 4, 6]\nlook_at = [0, 0.5, -1]\nfov = 60\n",
        {{"m.obj", mixedObj()}});
    const std::string text = settings(0.5, 16);
    const Picture both = draw(makeConfig(text), scene),
                  alone = draw(makeConfig(text.substr(0, text.find("[output]"))
                                   + "[output]\naovs = ['ambient_occlusion_error']\n"),
                      scene);
    EXPECT_EQ(alone.aov("ambient_occlusion_error").pixels, both.aov("ambient_occlusion_error").pixels);
}

TEST(Reference, aPlaneIsOpen) {
    const LoadedScene plane = makeScene(
        "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\nposition = [0, 3, 20]\nlook_at = [0, 0, 0]\nfov = 60\n",
        {{"p.obj", quadObj({-500, 0, 500}, {500, 0, 500}, {500, 0, -500}, {-500, 0, -500})}});
    for (const double radius : {0.01, 1.0, 100.0}) {
        const Picture p = draw(makeConfig(settings(radius, 64)), plane);
        for (const float v : p.aov("ambient_occlusion_raw").pixels) EXPECT_EQ(v, 1.0f);
    }
}

// Two planes that meet at the edge x = z = 0 of the floor z… y is up: the floor is y = 0, x > 0; the other plane rises
// at `angle` from it.
TEST(Reference, wedgesHaveTheirAnalyticValue) {
    for (const double degrees : {45.0, 90.0, 135.0}) {
        const double a = glm::radians(degrees);
        const glm::dvec3 along(std::cos(a) * 100, std::sin(a) * 100, 0);
        const std::string obj = quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, -100}, {0, 0, -100})
            + quadObj({0, 0, 100}, {along.x, along.y, 100}, {along.x, along.y, -100}, {0, 0, -100});
        // For an acute wedge the eye stands inside it.
        const LoadedScene scene = makeScene(
            "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\nposition = [4, 1.5, 0]\nlook_at = [0.2, 0, 0]\nfov = "
            "60\n",
            {{"p.obj", obj}});
        const double radius = 2;
        const Picture p = draw(makeConfig(settings(radius, 1024)), scene);
        // A direction meets the other plane, of normal m, where −ω·m ≥ distance / R.
        const glm::dvec3 m(std::sin(a), -std::cos(a), 0);
        std::map<int, double> known;  // by distance from the edge in hundredths
        compare(
            p,
            [&](const glm::dvec3& at) {
                if (at.y > 1e-4 || at.x < 0.02) return -1.0;
                const int key = static_cast<int>(std::lround(at.x * 100));
                if (std::abs(at.x * 100 - key) > 0.02) return -1.0;
                if (!known.contains(key)) {
                    const double distance = glm::dot(at, m);
                    known[key] = 1 - hiddenShare([&](const glm::dvec3& w) {
                        return -(w.x * m.x + w.z * m.y) >= distance / radius;
                    });
                }
                return known[key];
            },
            40);
    }
}

TEST(Reference, falloffWeighsByDistance) {
    const std::string obj = quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, -100}, {0, 0, -100})
        + quadObj({0, 0, 100}, {0, 100, 100}, {0, 100, -100}, {0, 0, -100});
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\nposition = [4, 1.5, 0]\nlook_at = [0.2, 0, 0]\nfov = 60\n",
        {{"p.obj", obj}});
    const double radius = 2;
    for (const bool linear : {true, false}) {
        const Picture p = draw(
            makeConfig(settings(radius, 1024, linear ? "falloff = 'linear'\n" : "falloff = 'quadratic'\n")), scene);
        compare(
            p,
            [&](const glm::dvec3& at) {
                if (at.y > 1e-4 || at.x < 0.02 || std::abs(at.z) > 0.05) return -1.0;
                constexpr int n = 400;
                double sum = 0, total = 0;
                for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n; ++j) {
                        const double x = (i + 0.5) * 2 / n - 1, y = (j + 0.5) * 2 / n - 1;
                        if (x * x + y * y >= 1) continue;
                        ++total;
                        const double share = at.x / std::max(-x, 1e-9) / radius;
                        if (share <= 1) sum += 1 - (linear ? share : share * share);
                    }
                return 1 - sum / total;
            },
            20);
    }
}

TEST(Reference, aSphereOnAPlaneHidesItsFormFactor) {
    const double r = 1;
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 's'\nfile = 's.obj'\n[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[instance]]\nmesh = "
        "'s'\ntranslate = [0, 1, 0]\n[[instance]]\nmesh = 'p'\n[[camera]]\nposition = [0, 6, 6]\nlook_at = [0, 0, "
        "0]\nfov = 50\n",
        {{"s.obj", sphereObj(r, 256)}, {"p.obj", quadObj({-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50})}});
    compare(
        draw(makeConfig(settings(60, 1024)), scene),
        [&](const glm::dvec3& at) {
            if (at.y > 1e-4) return -1.0;
            // Differential area to a sphere wholly above its horizon: (r/d)² cos θ, and cos θ = r/d.
            const double d = std::sqrt(at.x * at.x + at.z * at.z + r * r);
            return 1 - r * r * r / (d * d * d);
        },
        1000);
}

// Instances that share a tree are the scene that has them copied out, within what one more transform rounds.
TEST(Reference, instancesAreTheirCopies) {
    const std::string box = boxObj({-0.5, 0, -0.5}, {0.5, 1, 0.5});
    std::string shared = "[[mesh]]\nname = 'b'\nfile = 'b.obj'\n", copied,
                camera = "[[camera]]\nposition = [4, 5, 6]\nlook_at = [0, 0.5, 0]\nfov = 50\n";
    std::vector<std::pair<std::string, std::string>> files{{"b.obj", box}};
    for (int i = 0; i < 5; ++i) {
        const std::string place = fmt::format("translate = [{}, {}, {}]\nrotate = [0, {}, 0]\nscale = [1, {}, 1]\n",
            i - 2.0, 0.1 * i, 0.3 * i, 17 * i, 1 + 0.2 * i);
        shared += "[[instance]]\nmesh = 'b'\n" + place;
        copied += fmt::format("[[mesh]]\nname = 'b{0}'\nfile = 'b{0}.obj'\n[[instance]]\nmesh = 'b{0}'\n", i) + place;
        files.emplace_back(fmt::format("b{}.obj", i), box);
    }
    const Picture a = draw(makeConfig(settings(1, 64)), makeScene(shared + camera, files)),
                  b = draw(makeConfig(settings(1, 64)), makeScene(copied + camera, files));
    const auto &pa = a.aov("ambient_occlusion_raw").pixels, &pb = b.aov("ambient_occlusion_raw").pixels;
    int different = 0;
    for (std::size_t i = 0; i < pa.size(); ++i) different += std::abs(pa[i] - pb[i]) > 1.5 / 64;
    EXPECT_LE(different, static_cast<int>(pa.size() / 1000)) << "a ray or two may graze an edge differently";
}

// The ambient occlusion of Blender's Cycles, 512 samples per pixel: an independent ray tracer with noise of its own.
// Its samples are spread over the pixel (at outlines its values are those of sixteen of our samples, not of one), so
// ours are as well.
TEST(Reference, agreesWithCycles) {
    const char* data = std::getenv("LIMN_TEST_DATA");
    if (!data) GTEST_SKIP() << "LIMN_TEST_DATA is not set";
    struct Shot {
        const char* scene;
        char camera;
        double radius;
        glm::dvec3 position, target;
    };
    const Shot shots[] = {{"room", 'A', 0.5, {0.3, 1.6, 4.8}, {-0.1, 1.1, -3}},
        {"room", 'B', 0.5, {-1.9, 1.2, 3.6}, {1.5, 0.6, -2.5}}, {"thin", 'A', 0.5, {2.7, 1.8, 3.6}, {0, 0.45, 0.3}},
        {"thin", 'B', 0.5, {-2.6, 0.9, 3.2}, {0.3, 0.5, 0}}, {"bust", 'A', 0.3, {1.6, 1.6, 2.6}, {0, 0.95, 0}},
        {"bust", 'B', 0.3, {-1.2, 1.1, 2.3}, {0, 1.0, 0}}};
    const double fov = glm::degrees(2 * std::atan(std::tan(glm::radians(30.0)) * 640 / 360));
    for (const Shot& shot : shots) {
        const std::string folder = std::string(data) + "/ao_scenes/";
        const LoadedScene scene = makeScene(
            fmt::format("[[mesh]]\nname = 'm'\nfile = '{}{}.obj'\n[[camera]]\nposition = {}\nlook_at = {}\nfov = {}\n",
                folder, shot.scene, toml(shot.position), toml(shot.target), fov),
            {});
        const Picture p =
            draw(makeConfig(fmt::format(
                     "shading = 'flat'\n[image]\nsize = [640, 360]\nsamples = 16\nao_samples = 16\n[ao]\ntechnique = "
                     "'ray_traced'\nradius = {}\nrays = 32\n[output]\naovs = ['ambient_occlusion_raw', 'depth']\n",
                     shot.radius)),
                scene);
        const Image theirs = readImage(fmt::format("{}{}_{}.cycles512.png", folder, shot.scene, shot.camera));
        ASSERT_EQ(theirs.width, 640);
        // The file holds linear numbers, the reader takes every PNG for sRGB.
        const auto open = [&](int x, int y) { return linearToSrgb(theirs.at(x, y)[0]); };
        double squares = 0, sum = 0;
        int count = 0;
        for (int y = 0; y < 360; ++y)
            for (int x = 0; x < 640; ++x) {
                // On the background they say 0 and we say 1: pixels that may have a part in it do not count.
                bool inside = true;
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, 359); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, 639); ++u)
                        inside = inside && std::isfinite(*p.aov("depth").at(u, v));
                if (!inside) continue;
                const double difference = *p.aov("ambient_occlusion_raw").at(x, y) - open(x, y);
                squares += difference * difference;
                sum += difference;
                ++count;
            }
        RecordProperty(
            fmt::format("{}_{}", shot.scene, shot.camera), fmt::format("{:.4f}", std::sqrt(squares / count)));
        fmt::print("{}_{}: RMSE {:.4f}, mean {:+.4f} over {} pixels\n", shot.scene, shot.camera,
            std::sqrt(squares / count), sum / count, count);
        // Their noise is 0.015 · √(64/512) = 0.0053, ours less; outlines, where sixteen samples do not give the share
        // of 512, add the rest.
        EXPECT_LE(std::sqrt(squares / count), 0.012) << shot.scene << "_" << shot.camera;
        EXPECT_LE(std::abs(sum / count), 0.001) << shot.scene << "_" << shot.camera;
    }
}

}  // namespace
}  // namespace limn::test
