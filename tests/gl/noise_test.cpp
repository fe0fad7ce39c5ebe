// What is left of the noise of a few taps: no pattern on walls, and no ragged bands.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>

namespace limn::test {
namespace {

constexpr int kBlock = 128;
using Spectrum = std::array<std::array<double, kBlock>, kBlock>;

/// The rows between two strips as high as the reach of ambient occlusion, which does not look beyond the picture.
Image withoutBorder(const Image& image, int border) {
    const auto first = static_cast<std::ptrdiff_t>(border) * image.width;
    return {image.width, image.height - 2 * border, 1, {image.pixels.begin() + first, image.pixels.end() - first}};
}

/// The power of each frequency of a picture's error, mean over its blocks (Welch's method, with Hann's window). The
/// true value depends on the column alone: what differs from a column's mean is error.
Spectrum spectrumOf(const Image& image) {
    std::vector<double> columns(static_cast<std::size_t>(image.width));
    for (int x = 0; x < image.width; ++x)
        for (int y = 0; y < image.height; ++y)
            columns[static_cast<std::size_t>(x)] += static_cast<double>(*image.at(x, y)) / image.height;
    const auto window = [](int i) { return std::pow(std::sin(M_PI * (i + 0.5) / kBlock), 2); };
    std::array<std::complex<double>, kBlock> turns;  // of the circle
    for (int i = 0; i < kBlock; ++i) turns[i] = std::polar(1.0, -2 * M_PI * i / kBlock);
    Spectrum power{};
    for (int top = 0; top + kBlock <= image.height; top += kBlock)
        for (int left = 0; left + kBlock <= image.width; left += kBlock) {
            std::array<std::array<std::complex<double>, kBlock>, kBlock> rows{};
            for (int y = 0; y < kBlock; ++y)
                for (int x = 0; x < kBlock; ++x) {
                    const double error =
                        static_cast<double>(*image.at(left + x, top + y)) - columns[static_cast<std::size_t>(left + x)];
                    for (int k = 0; k < kBlock; ++k)
                        rows[y][k] += turns[k * x % kBlock] * (error * window(x) * window(y));
                }
            for (int l = 0; l < kBlock; ++l)
                for (int k = 0; k < kBlock; ++k) {
                    std::complex<double> sum;
                    for (int y = 0; y < kBlock; ++y) sum += rows[y][k] * turns[l * y % kBlock];
                    power[l][k] += std::norm(sum);
                }
        }
    return power;
}

/// The largest ratio of a frequency's power to the mean of those around it. The window spreads a frequency over those
/// beside it, so that its neighbours begin two further. The lowest are left out: slow changes are no pattern.
double highestPeak(const Spectrum& power) {
    double highest = 0;
    for (int l = 0; l < kBlock; ++l)
        for (int k = 0; k < kBlock; ++k) {
            if (std::max(std::min(k, kBlock - k), std::min(l, kBlock - l)) <= 2) continue;
            double around = 0;
            int count = 0;
            for (int dl = -3; dl <= 3; ++dl)
                for (int dk = -3; dk <= 3; ++dk)
                    if (std::max(std::abs(dl), std::abs(dk)) >= 2) {
                        around += power[(l + dl + kBlock) % kBlock][(k + dk + kBlock) % kBlock];
                        ++count;
                    }
            highest = std::max(highest, power[l][k] * count / around);
        }
    return highest;
}

const char* kFloorBesideAWall =
    "position = [0.32, 30, 0]\nlook_at = [0.32, 0, 0]\nup = [0, 0, -1]\northographic_height = 6.395\n";

LoadedScene wedge(const char* camera) {
    return makeScene(fmt::format("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\n{}", camera),
        {{"p.obj",
            quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, -100}, {0, 0, -100})
                + quadObj({-100, 100, 100}, {0, 0, 100}, {0, 0, -100}, {-100, 100, -100})}});
}

// The power of noise scatters by a sixth over 34 blocks: 3 is far from chance. (Points on a lattice of pixels, as
// a recurrence of two irrational numbers gives them, reach 12 to 1700.)
TEST(Noise, leavesNoPatternOnAFlatWall) {
    const LoadedScene scene = wedge(kFloorBesideAWall);
    for (const char* technique :
        {"gtao", "hbao", "toon_ssao", "visibility_bitmask", "occlusion_function", "hemisphere"})
        for (const char* filter : {"plane_aware", "box"}) {
            const Picture p = draw(
                makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [256, 2592]\nsamples = 1\n[ao]\ntechnique = "
                                       "'{}'\nradius = 0.5\nfilter = '{}'\n[output]\naovs = ['ambient_occlusion']\n",
                    technique, filter)),
                scene);
            const double peak = highestPeak(spectrumOf(withoutBorder(p.aov("ambient_occlusion"), 208)));
            RecordProperty(fmt::format("{}_{}", technique, filter), fmt::format("{:.2f}", peak));
            EXPECT_LT(peak, 3) << technique << " with " << filter;
        }
}

double rmsBetween(const Picture& a, const Picture& b) {
    const auto &x = a.aov("ambient_occlusion").pixels, &y = b.aov("ambient_occlusion").pixels;
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        sum += std::pow(static_cast<double>(x[i]) - static_cast<double>(y[i]), 2);
    return std::sqrt(sum / static_cast<double>(x.size()));
}

// Rays of a pixel's samples complete each other: sixteen samples of sixteen rays are about as good as 256 rays at once.
// (When each sample continued one recurrence, its steps met with a ratio near 1/4, and they were 3 times as bad.)
TEST(Noise, ofRaysIsSpreadOverSamples) {
    const LoadedScene scene = wedge(kFloorBesideAWall);
    const auto traced = [&](int samples, int rays) {
        return draw(makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [64, 48]\nsamples = {0}\nao_samples = "
                                           "{0}\n[ao]\ntechnique = 'ray_traced'\nradius = 0.5\nrays = {1}\n[output]\n"
                                           "aovs = ['ambient_occlusion']\n",
                        samples, rays)),
            scene);
    };
    const double together = rmsBetween(traced(1, 256), traced(1, 4096)),
                 apart = rmsBetween(traced(16, 16), traced(16, 256));
    RecordProperty("apart_over_together", fmt::format("{:.2f}", apart / together));
    EXPECT_GT(together, 0);
    EXPECT_LT(apart, 1.5 * together);
}

/// How far the edge of a band wanders from its own mean over 21 columns: standard deviation in pixels. The lower part
/// of the picture holds one edge, between the darkest value in it and the lightest.
double raggedness(const Image& image) {
    const int top = image.height * 7 / 20, margin = image.width / 4;
    float dark = 1e9f, light = 0;
    for (int y = top; y < image.height; ++y)
        for (int x = margin; x < image.width - margin; ++x)
            dark = std::min(dark, image.at(x, y)[1]), light = std::max(light, image.at(x, y)[1]);
    EXPECT_GT(light, 1.2f * dark) << "there is no edge";
    std::vector<double> places;
    for (int x = margin; x < image.width - margin; ++x) {
        double place = 0;
        for (int y = top; y < image.height; ++y)
            place += static_cast<double>((image.at(x, y)[1] - dark) / (light - dark));
        places.push_back(place);
    }
    double sum = 0;
    const auto count = static_cast<int>(places.size());
    for (int i = 10; i + 10 < count; ++i) {
        const double mean = std::accumulate(places.begin() + i - 10, places.begin() + i + 11, 0.0) / 21;
        sum += std::pow(places[static_cast<std::size_t>(i)] - mean, 2);
    }
    return std::sqrt(sum / (count - 20));
}

// A wall darkens a floor: on both the edge of a band is straight. Light makes such an edge on a cylinder, as straight
// as the rasterizer's samples: within 0.01 pixels. Ambient occlusion by the recipe of the shipped toon configs comes
// within a tenth of a pixel (measured: 0.07), which eight samples cannot tell from straight; with a narrow filter it
// wanders by 0.8.
TEST(Noise, leavesTheBandsOfToonShadingStraight) {
    const LoadedScene corner = makeScene(
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[camera]]\nposition = [0, 6, 8]\nlook_at = [0, 0, 1.2]\nfov = "
        "40\n[[light]]\ndirection = [0, -1, -0.9]\nintensity = 0.9\n",
        {{"m.obj",
            quadObj({-20, 0, 20}, {20, 0, 20}, {20, 0, 0}, {-20, 0, 0})
                + quadObj({-20, 0, 0}, {20, 0, 0}, {20, 12, 0}, {-20, 12, 0})}});
    const auto ragged = [&](const std::string& filter, int aoSamples) {
        return raggedness(draw(
            makeConfig(fmt::format("[image]\nsize = [640, 360]\nsamples = 8\nao_samples = {}\n[shading]\ntechnique = "
                                   "'toon'\nbands = 6\nambient = 0.12\n[ao]\ntechnique = 'toon_ssao'\nradius = "
                                   "1.6\nstrength = 2\npoints = 12\nfilter = {}\n",
                aoSamples, filter)),
            corner)
                              .aov("beauty"));
    };
    EXPECT_LT(ragged("{ technique = 'plane_aware', passes = 4 }", 2), 0.1);
    EXPECT_GT(ragged("{ technique = 'gaussian', iterations = 5 }", 4), 0.4);
}

}  // namespace
}  // namespace limn::test
