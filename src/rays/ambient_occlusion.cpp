#include "rays/ambient_occlusion.h"

#include "picture/aov.h"
#include "picture/directions.h"

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace limn {
namespace {

constexpr int kPacket = 16;  // rays that Embree takes at once

std::uint32_t mixBits(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

std::uint32_t reversed(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
}

/// The second coordinate of Sobol's (0, 2)-sequence; the first is the reversed number itself.
std::uint32_t sobol(std::uint32_t number) {
    std::uint32_t x = reversed(number);
    x ^= x << 1 & 0xaaaaaaaau;
    x ^= x << 2 & 0xccccccccu;
    x ^= x << 4 & 0xf0f0f0f0u;
    x ^= x << 8 & 0xff00ff00u;
    return x ^ x << 16;
}

/// Turns each digit at random by the digits above it, which keeps nets nets (Owen 1995; hashed as by Burley, "Practical
/// Hash-based Owen Scrambling", JCGT 2020).
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversed(x);
}

/// Cosine-weighted directions around z, for the 16 pixels of a 4×4 tile one after the other. They are points of a
/// (0, 2)-sequence whose number is (sample xor pixel) · rays + ray: evenly spread over a pixel's rays and samples, and
/// over the rays of any block of 4×4 pixels, which a filter joins. What is finer than a block's own points differs at
/// random between samples.
std::vector<glm::vec3> spreadDirections(int rays, int sample, std::uint32_t seed) {
    std::vector<glm::vec3> directions;
    directions.reserve(16 * static_cast<std::size_t>(rays));
    const auto s = static_cast<std::uint32_t>(sample), count = static_cast<std::uint32_t>(rays);
    const auto known = static_cast<int>(std::bit_width((std::bit_ceil(std::max(s + 1, 16u))) * count - 1));
    const std::uint32_t finer = known < 32 ? ~0u >> known : 0;
    for (std::uint32_t pixel = 0; pixel < 16; ++pixel)
        for (std::uint32_t ray = 0; ray < count; ++ray) {
            const std::uint32_t number = (s ^ pixel) * count + ray;
            const std::uint32_t first = reversed(number) ^ (mixBits(2 * s + 1) & finer),
                                second = sobol(number) ^ (mixBits(2 * s + 2) & finer);
            const double u = scrambled(first, mixBits(2 * seed + 1)) * 0x1p-32,
                         angle = scrambled(second, mixBits(2 * seed + 2)) * (0x1p-31 * 3.14159265358979);
            directions.emplace_back(std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1 - u));
        }
    return directions;
}

/// The pixel's number among the 16. The last two bits differ in each row, in each column, and in almost every block of
/// 2×2 pixels: their rays are evenly spread as well.
std::size_t placeInTile(glm::ivec2 pixel) {
    constexpr unsigned kTurn[4] = {0, 2, 1, 3};
    const auto x = static_cast<unsigned>(pixel.x) & 3, y = static_cast<unsigned>(pixel.y) & 3;
    return (x ^ kTurn[y]) | y << 2;
}

/// Two vectors that complete a unit normal to a basis (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT
/// 2017).
void complete(const glm::vec3& n, glm::vec3& a, glm::vec3& b) {
    const float sign = std::copysign(1.0f, n.z), p = -1 / (sign + n.z), q = n.x * n.y * p;
    a = {1 + sign * n.x * n.x * p, sign * q, -sign * n.x};
    b = {q, sign + n.y * n.y * p, -n.y};
}

struct Origin {
    glm::vec3 position, normal, tangent, bitangent;
};

/// Traces rays in packets, and gives the hidden part V·w of each.
class Packet {
public:
    Packet(RTCScene scene, const OcclusionQuery& query)
        : scene_(scene), radius_(static_cast<float>(query.radius)), falloff_(query.falloff) {
        rtcInitIntersectContext(&context_);
    }

    void add(const Origin& origin, const glm::vec3& local, float* result) {
        const glm::vec3 d = origin.tangent * local.x + origin.bitangent * local.y + origin.normal * local.z;
        RTCRay16& r = hit_.ray;
        r.org_x[count_] = origin.position.x;
        r.org_y[count_] = origin.position.y;
        r.org_z[count_] = origin.position.z;
        r.dir_x[count_] = d.x;
        r.dir_y[count_] = d.y;
        r.dir_z[count_] = d.z;
        results_[count_] = result;
        if (++count_ == kPacket) flush();
    }

    void flush() {
        if (count_ == 0) return;
        RTCRay16& r = hit_.ray;
        alignas(64) int valid[kPacket];
        for (int i = 0; i < kPacket; ++i) {
            valid[i] = i < count_ ? -1 : 0;
            r.tnear[i] = 0;
            r.tfar[i] = radius_;
            r.time[i] = 0;
            r.mask[i] = ~0u;
            r.id[i] = 0;
            r.flags[i] = 0;
            hit_.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        if (falloff_ == Falloff::none)
            rtcOccluded16(valid, scene_, &context_, &r);
        else
            rtcIntersect16(valid, scene_, &context_, &hit_);
        for (int i = 0; i < count_; ++i) {
            if (falloff_ == Falloff::none) {
                *results_[i] = r.tfar[i] < 0 ? 1.0f : 0.0f;
            } else {
                const float share = r.tfar[i] / radius_;
                *results_[i] = hit_.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                    ? 0.0f
                    : 1 - (falloff_ == Falloff::linear ? share : share * share);
            }
        }
        count_ = 0;
    }

private:
    RTCScene scene_;
    float radius_;
    Falloff falloff_;
    RTCIntersectContext context_;
    alignas(64) RTCRayHit16 hit_{};
    float* results_[kPacket]{};
    int count_ = 0;
};

}  // namespace

void traceAmbientOcclusion(const RayScene& scene, const View& view, const SeenSurfaces& surfaces,
    const OcclusionQuery& query, const PixelRect& part, std::span<float> visibility, std::span<float> error) {
    const glm::dmat4 raysFromView = scene.raysFromView(view);
    const glm::dmat3 rotation(raysFromView);
    const int rays = query.rays;
    // There must be enough groups to measure a spread, and enough rays in each group to be evenly spread.
    const int groups = rays >= 64 ? 16 : rays >= 16 ? 4 : 1;
    // Of the samples that ambient occlusion is found in: a pixel's rays are to cover all of its hemisphere.
    const int samples = view.sampling.samples();
    const bool isPartial = view.aoSamples > 0 && view.aoSamples < samples;
    const int run = isPartial ? view.sample * view.aoSamples / samples : view.sample;
    const std::vector<glm::vec3> directions = spreadDirections(rays, run, view.seed);
    const auto number = [](int value) { return static_cast<std::size_t>(value); };
    tbb::parallel_for(tbb::blocked_range<int>(part.origin.y, part.origin.y + part.size.y, 4),
        [&](const tbb::blocked_range<int>& rows) {
            Packet packet(scene.handle(), query);
            std::vector<float> hidden(number(part.size.x) * number(rays));
            for (int y = rows.begin(); y < rows.end(); ++y) {
                const std::size_t row = number(y) * number(view.region.size.x) + number(part.origin.x);
                for (int x = 0; x < part.size.x; ++x) {
                    const std::size_t at = row + number(x);
                    const float depth = surfaces.depth[at];
                    if (depth == kBackgroundDepth) continue;
                    const glm::ivec2 pixel = view.region.origin + glm::ivec2(part.origin.x + x, y);
                    const glm::dvec2 ray = (glm::dvec2(pixel) + 0.5) * view.rayScale + view.rayOffset;
                    const double z = static_cast<double>(depth);
                    const glm::dvec3 position(raysFromView * glm::dvec4(view.orthographic ? ray : ray * z, -z, 1));
                    Origin origin;
                    origin.normal = glm::vec3(glm::normalize(rotation
                        * glm::dvec3(decodeDirection(
                            {surfaces.normalGeometric[2 * at], surfaces.normalGeometric[2 * at + 1]}))));
                    complete(origin.normal, origin.tangent, origin.bitangent);
                    // Coordinates, their depth, and the tree's own vertices are each rounded by 2^-24 of their size:
                    // take four times the sum.
                    const double slack =
                        (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z), 1.0}) * 2 + z)
                        * 0x1p-22;
                    origin.position = glm::vec3(position + glm::dvec3(origin.normal) * slack);
                    const glm::vec3* local = &directions[placeInTile(pixel) * number(rays)];
                    for (int i = 0; i < rays; ++i)
                        packet.add(origin, local[i], &hidden[number(x) * number(rays) + number(i)]);
                }
                packet.flush();
                for (int x = 0; x < part.size.x; ++x) {
                    const std::size_t at = row + number(x);
                    if (surfaces.depth[at] == kBackgroundDepth) {
                        if (!visibility.empty()) visibility[at] = 1;
                        if (!error.empty()) error[at] = 0;
                        continue;
                    }
                    const std::span<const float> all(&hidden[number(x) * number(rays)], number(rays));
                    double sum = 0;
                    for (const float h : all) sum += static_cast<double>(h);
                    const double mean = sum / rays;
                    if (!visibility.empty()) visibility[at] = static_cast<float>(1 - mean);
                    if (error.empty()) continue;
                    double variance = 0;
                    if (groups > 1) {
                        const int size = rays / groups;
                        for (int g = 0; g < groups; ++g) {
                            double group = 0;
                            for (int i = 0; i < size; ++i) group += static_cast<double>(all[number(g * size + i)]);
                            variance += (group / size - mean) * (group / size - mean);
                        }
                        variance /= groups * (groups - 1);
                    } else {
                        // With Laplace's rule a few equal hits do not claim certainty.
                        const double share = (sum + 1) / (rays + 2);
                        variance = share * (1 - share) / rays;
                    }
                    error[at] = static_cast<float>(std::sqrt(variance));
                }
            }
        });
}

}  // namespace limn
