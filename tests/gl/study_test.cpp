// Figures of studies, against analytic truth.

#include "study/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limn::test {
namespace {

constexpr glm::ivec2 kSize(40, 30);

std::vector<float> picture(const std::function<double(int, int)>& value) {
    std::vector<float> pixels;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) pixels.push_back(static_cast<float>(value(x, y)));
    return pixels;
}

TEST(Similarity, ofEvenPicturesIsThatOfTheirMeans) {
    const auto a = picture([](int, int) { return 0.25; }), b = picture([](int, int) { return 0.75; });
    EXPECT_NEAR(similarity(a, a, kSize), 1, 1e-12);
    EXPECT_NEAR(similarity(a, b, kSize), (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 1e-9);
    EXPECT_EQ(similarity(a, b, kSize), similarity(b, a, kSize));
}

// Under a window of many pixels a fine pattern of height h has the variance h² and hardly a mean of its own.
TEST(Similarity, fallsWithContrastAsTheFormulaSays) {
    const double h = 0.3, s = 0.5;
    const auto pattern = [](double height) {
        return picture([height](int x, int y) { return 0.5 + ((x + y) % 2 == 0 ? height : -height); });
    };
    EXPECT_NEAR(
        similarity(pattern(h), pattern(s * h), kSize), (2 * s * h * h + 9e-4) / ((1 + s * s) * h * h + 9e-4), 1e-3);
    EXPECT_NEAR(similarity(pattern(h), pattern(-h), kSize), (-2 * h * h + 9e-4) / (2 * h * h + 9e-4), 1e-3);
}

TEST(Deviations, leaveOutWhatHasNoTruth) {
    const std::vector<float> seen{0.5f, 0.7f, 1, 0}, truth{0.5f, 0.5f, -1, 0.2f};
    const Deviation off = compare(seen, truth);
    EXPECT_NEAR(off.bias, 0, 1e-7);
    EXPECT_NEAR(off.rmse, std::sqrt(0.08 / 3), 1e-7);
}

StudyPoint pointAt(double milliseconds, double error) {
    StudyPoint point;
    point.milliseconds = milliseconds;
    point.picture.rmse = error;
    return point;
}

TEST(Fronts, holdWhatNothingBeats) {
    const std::vector<StudyPoint> points{
        pointAt(4, 0.1), pointAt(1, 0.4), pointAt(2, 0.5), pointAt(2, 0.2), pointAt(3, 0.2), pointAt(8, 0.05)};
    EXPECT_EQ(paretoFront(points, false), (std::vector<std::size_t>{1, 3, 0, 5}));
    const auto front = paretoFront(points, false);
    const FrontFit fit = fitFront(points, front, false);  // error = 0.4 / milliseconds
    EXPECT_NEAR(fit.exponent, -1, 1e-9);
    EXPECT_NEAR(fit.factor, 0.4, 1e-9);
    EXPECT_NEAR(fit.spread, 0, 1e-9);
}

TEST(Fronts, ofTwoPointsHaveNoLaw) {
    const std::vector<StudyPoint> points{pointAt(1, 0.4), pointAt(2, 0.2)};
    EXPECT_EQ(fitFront(points, paretoFront(points, false), false).points, 0);
}

}  // namespace
}  // namespace limn::test
