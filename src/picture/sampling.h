// The samples of a picture: how many there are, where in a pixel each looks, and which passes run in it.
//
// A rate says in how many of a frame's samples something runs: those are spread evenly over all of them, the first one
// is always among them, and two things of one rate run in the same samples.
#pragma once

#include <glm/glm.hpp>

namespace limn {

/// Something runs in every sample.
inline constexpr int kEverySample = 0;

/// n samples are n = raster² · subFrames. A sub-frame's triangles are drawn once, on a raster finer than the picture;
/// every pass after that runs once per sample, at the picture's own size, on every raster-th fine pixel.
struct Sampling {
    int raster = 1;
    int subFrames = 1;

    int perSubFrame() const { return raster * raster; }
    int samples() const { return perSubFrame() * subFrames; }
    int subFrameOf(int sample) const { return sample / perSubFrame(); }
    /// Which fine pixel of each pixel a sample looks at: samples that follow each other, and those at even distances,
    /// lie well apart.
    glm::ivec2 placeOnRaster(int sample) const;
    /// Offset of a sub-frame within a fine pixel, in fine pixels: Hammersley points, centred so that their mean is the
    /// pixel's centre.
    glm::dvec2 jitterOf(int subFrame) const;
    /// Does what has this rate run in the sample?
    bool runs(int rate, int sample) const;
    /// In how many samples it runs.
    int count(int rate) const { return rate == kEverySample ? samples() : rate; }
};

/// As fine a raster as divides n, fits the driver, and keeps its fine pixels below 2^24: triangles are then drawn least
/// often.
Sampling splitSamples(int samples, glm::ivec2 size, int maxTextureSize);

}  // namespace limn
