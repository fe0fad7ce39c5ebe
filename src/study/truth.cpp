#include "study/truth.h"

#include "picture/directions.h"
#include "rays/ambient_occlusion.h"
#include "study/shell.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

double percentile99(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), rank, values.end());
    return *rank;
}

Deviation compare(std::span<const float> picture, std::span<const float> truth) {
    std::vector<double> off;
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        if (truth[i] < 0) continue;
        const double d = static_cast<double>(picture[i]) - static_cast<double>(truth[i]);
        sum += d;
        squares += d * d;
        off.push_back(std::abs(d));
    }
    if (off.empty()) return {};
    const auto n = static_cast<double>(off.size());
    return {std::sqrt(squares / n), sum / n, percentile99(std::move(off))};
}

void Halves::join(std::vector<float>& first, std::span<const float> second, std::span<const float> depth) {
    for (std::size_t i = 0; i < first.size(); ++i) {
        const double off = 0.5 * (static_cast<double>(first[i]) - static_cast<double>(second[i]));
        const bool isSurface = std::isfinite(depth[i]);
        first[i] = isSurface ? 0.5f * (first[i] + second[i]) : -1;
        if (!isSurface) continue;
        squares_ += off * off;
        ++count_;
    }
}

namespace {

constexpr int kReach = 5;  // of windows, to each side

/// Blurs rows or columns by a Gaussian, mirrored at the borders.
std::vector<double> blurred(const std::vector<double>& values, glm::ivec2 size, glm::ivec2 along) {
    std::array<double, 2 * kReach + 1> weights{};
    double sum = 0;
    for (int k = -kReach; k <= kReach; ++k) sum += weights[k + kReach] = std::exp(-k * k / (2 * 1.5 * 1.5));
    std::vector<double> result(values.size());
    const auto mirrored = [](int i, int n) {
        i = i < 0 ? -i - 1 : i;
        return std::clamp(i >= n ? 2 * n - 1 - i : i, 0, n - 1);
    };
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            double value = 0;
            for (int k = -kReach; k <= kReach; ++k) {
                const int fromX = mirrored(x + k * along.x, size.x), fromY = mirrored(y + k * along.y, size.y);
                value += weights[k + kReach] * values[static_cast<std::size_t>(fromY) * size.x + fromX];
            }
            result[static_cast<std::size_t>(y) * size.x + x] = value / sum;
        }
    });
    return result;
}

std::vector<double> windowed(std::vector<double> values, glm::ivec2 size) {
    return blurred(blurred(values, size, {1, 0}), size, {0, 1});
}

}  // namespace

double similarity(std::span<const float> a, std::span<const float> b, glm::ivec2 size) {
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    std::vector<double> x(a.begin(), a.end()), y(b.begin(), b.end()), xx, yy, xy;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx.push_back(x[i] * x[i]);
        yy.push_back(y[i] * y[i]);
        xy.push_back(x[i] * y[i]);
    }
    const auto meanX = windowed(x, size), meanY = windowed(y, size), meanXX = windowed(xx, size),
               meanYY = windowed(yy, size), meanXY = windowed(xy, size);
    double sum = 0;
    for (std::size_t i = 0; i < meanX.size(); ++i) {
        const double mx = meanX[i], my = meanY[i];
        const double vx = meanXX[i] - mx * mx, vy = meanYY[i] - my * my, cov = meanXY[i] - mx * my;
        sum += (2 * mx * my + kC1) * (2 * cov + kC2) / ((mx * mx + my * my + kC1) * (vx + vy + kC2));
    }
    return sum / static_cast<double>(std::max<std::size_t>(meanX.size(), 1));
}

std::vector<float> shellVisibility(
    const RenderedFrame& seen, const SceneInfo& scene, const Length& radius, int rays, glm::ivec2 wanted) {
    const auto shell = buildShell(seen.view, scene, seen.layers[0].image.pixels, seen.layers[1].image.pixels);
    const glm::ivec2 size = seen.view.region.size;
    const auto pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    std::vector<float> depth(pixels), normals(2 * pixels), visibility(pixels, 1.0f);
    // Images have their rows from the upper left, views from the lower left.
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const std::size_t from = index(x, size.y - 1 - y), to = index(x, y);
            const float z = seen.layers[0].image.pixels[from];
            depth[to] =
                std::isfinite(z) ? static_cast<float>(static_cast<double>(z) * seen.view.unit) : kBackgroundDepth;
            const float* n = &seen.layers[1].image.pixels[3 * from];
            const glm::vec2 encoded = encodeDirection({n[0], n[1], n[2]});
            normals[2 * to] = encoded.x;
            normals[2 * to + 1] = encoded.y;
        }
    const int guard = seen.view.guard;
    traceAmbientOcclusion(*shell, seen.view, {depth, normals}, {seen.view.normalized(radius), Falloff::none, rays},
        {glm::ivec2(guard), wanted}, visibility, {});
    std::vector<float> picture;
    for (int y = 0; y < wanted.y; ++y)
        for (int x = 0; x < wanted.x; ++x) picture.push_back(visibility[index(x + guard, size.y - 1 - (y + guard))]);
    return picture;
}

std::vector<PixelClass> classifyPixels(const RenderedFrame& seen) {
    constexpr int kNear = 3;
    const Image &depth = seen.layers[0].image, &normals = seen.layers[1].image;
    const glm::ivec2 size(depth.width, depth.height);
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    };
    const auto place = [&](int x, int y) {
        return placeOf(seen.view, x, y, static_cast<double>(*depth.at(x, y)) * seen.view.unit);
    };
    const auto jumps = [&](int x, int y, int toX, int toY) {
        if (toX < 0 || toY < 0 || toX >= size.x || toY >= size.y) return false;
        const bool here = std::isfinite(*depth.at(x, y)), there = std::isfinite(*depth.at(toX, toY));
        if (!here || !there) return here != there;
        return !areJoined(seen.view, place(x, y), place(toX, toY), normals.at(x, y), normals.at(toX, toY));
    };
    std::vector<std::uint8_t> jump(depth.pixels.size());
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x)
            jump[index(x, y)] =
                jumps(x, y, x + 1, y) || jumps(x, y, x - 1, y) || jumps(x, y, x, y + 1) || jumps(x, y, x, y - 1);
    });
    const int border = std::max(size.x, size.y) / 20;
    std::vector<PixelClass> classes(depth.pixels.size(), PixelClass::background);
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            if (!std::isfinite(*depth.at(x, y))) continue;
            bool nearJump = false;
            for (int v = std::max(0, y - kNear); v <= std::min(size.y - 1, y + kNear); ++v)
                for (int u = std::max(0, x - kNear); u <= std::min(size.x - 1, x + kNear); ++u)
                    nearJump = nearJump || jump[index(u, v)];
            const bool nearBorder = x < border || y < border || x >= size.x - border || y >= size.y - border;
            classes[index(x, y)] = nearJump ? PixelClass::silhouette
                : nearBorder                ? PixelClass::border
                                            : PixelClass::inside;
        }
    });
    return classes;
}

}  // namespace limn
