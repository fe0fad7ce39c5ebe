#include "picture/sampling.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace limn {

glm::ivec2 Sampling::placeOnRaster(int sample) const {
    const int place = (sample + subFrameOf(sample) * (perSubFrame() / 2)) % perSubFrame(), row = place / raster;
    return {(place + row) % raster, row};
}

glm::dvec2 Sampling::jitterOf(int subFrame) const {
    const auto point = [this](int index) {
        double y = 0, digit = 0.5;
        for (int bits = index; bits > 0; bits >>= 1, digit *= 0.5) y += (bits & 1) * digit;
        return glm::dvec2((index + 0.5) / subFrames, y);
    };
    glm::dvec2 mean(0);
    for (int j = 0; j < subFrames; ++j) mean += point(j) / static_cast<double>(subFrames);
    return point(subFrame) - mean;
}

double Sampling::timeOf(int sample) const {
    // Multiples of a number that shares no divisor with n, near the golden section of n.
    const int n = samples();
    int step = std::max(1, static_cast<int>(0.618 * n + 0.5));
    while (std::gcd(step, n) != 1) ++step;
    const auto turn = static_cast<double>(std::int64_t{sample} * step % n);
    return (turn + 0.5) / n - 0.5;
}

bool Sampling::runs(int rate, int sample) const {
    const std::int64_t all = samples(), some = rate;
    return rate == kEverySample || sample == 0 || sample * some / all != (sample - 1) * some / all;
}

Sampling splitSamples(int samples, glm::ivec2 size, int maxTextureSize) {
    constexpr std::int64_t kMostPixels = 1 << 24;
    for (int raster = 4; raster > 1; --raster) {
        const glm::ivec2 fine = size * raster;
        const bool fits = std::max(fine.x, fine.y) <= maxTextureSize && std::int64_t{fine.x} * fine.y <= kMostPixels;
        if (samples % (raster * raster) == 0 && fits) return {raster, samples / (raster * raster)};
    }
    return {1, samples};
}

}  // namespace limn
