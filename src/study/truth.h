// Pictures compared with what is true.
#pragma once

#include "job/session.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// Errors over the pixels that count.
struct Deviation {
    double rmse = 0, bias = 0, p99 = 0;  ///< root mean square, mean, 99th percentile of the absolute difference
};

/// Pixels whose truth is below 0 do not count; `channels` of a pixel count one by one.
Deviation compare(std::span<const float> picture, std::span<const float> truth);

/// The 99th percentile; 0 of nothing.
double percentile99(std::vector<double> values);

/// True visibility from two halves that were drawn with seeds of their own: what they differ by is how far their mean
/// may be off.
class Halves {
public:
    /// Values of image.seed that no config has by chance.
    static constexpr const char* kSeeds[] = {"2147483646", "2147483645"};

    /// Turns the first half into the mean of both; below 0 where there is no surface, which is where depth is infinite.
    void join(std::vector<float>& first, std::span<const float> second, std::span<const float> depth);
    /// Root mean square, over all that was joined.
    double standardError() const { return count_ > 0 ? std::sqrt(squares_ / count_) : 0; }

private:
    double squares_ = 0, count_ = 0;
};

/// Structural similarity of two grey pictures (Wang, Bovik, Sheikh & Simoncelli, IEEE TIP 2004, eq. 13): windows with
/// Gaussian weights of sigma 1.5 over 11 × 11 pixels, K1 = 0.01, K2 = 0.03, values 0 … 1; the mean over all pixels,
/// whose windows are mirrored at the border. 1: the same.
double similarity(std::span<const float> a, std::span<const float> b, glm::ivec2 size);

/// Ambient visibility by rays against the depth buffer's own triangles: the best that a depth buffer allows. `seen` has
/// the layers depth and normal_geometric, with its guard band; rows from the upper left, without it, of `size`.
std::vector<float> shellVisibility(
    const RenderedFrame& seen, const SceneInfo& scene, const Length& radius, int rays, glm::ivec2 size);

/// Where a pixel lies: errors of ambient occlusion differ in kind.
enum class PixelClass : std::uint8_t { background, inside, silhouette, border };

/// Background: no surface at the pixel's centre. Border: within 5 % of the longer side from the picture's edge.
/// Silhouette: within three pixels of a jump in depth, which is where neighbours do not lie on each other's tangent
/// planes. `seen` as above, without guard band.
std::vector<PixelClass> classifyPixels(const RenderedFrame& seen);

}  // namespace limn
