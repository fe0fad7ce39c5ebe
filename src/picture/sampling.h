// The samples of a picture: their number, their places in a pixel, and the passes that run in each.
//
// A rate is the number of a frame's samples in which something runs. These samples are spread evenly and include the
// first. Two things of one rate run in the same samples.
#pragma once

#include <glm/glm.hpp>

namespace limn {

/// The rate of things that run in every sample.
inline constexpr int kEverySample = 0;

/// n samples are n = raster² · subFrames. A sub-frame's triangles are drawn once, on a raster finer than the picture;
/// every pass after that runs once per sample, at the picture's own size, on every raster-th fine pixel.
struct Sampling {
    int raster = 1;
    int subFrames = 1;

    int perSubFrame() const { return raster * raster; }
    int samples() const { return perSubFrame() * subFrames; }
    int subFrameOf(int sample) const { return sample / perSubFrame(); }
    /// The fine pixel that a sample looks at in each pixel. Consecutive samples, and those at even distances, lie well
    /// apart.
    glm::ivec2 placeOnRaster(int sample) const;
    /// Offset of a sub-frame within a fine pixel, in fine pixels: Hammersley points, centred so that their mean is the
    /// pixel's centre.
    glm::dvec2 jitterOf(int subFrame) const;
    /// When a sample is taken while a shutter is open, from -0.5 to 0.5 of that time: evenly, and in an order that goes
    /// along with no direction of jitterOf(). Samples at even distances are spread over all of it.
    double timeOf(int sample) const;
    /// Do things of this rate run in the sample?
    bool runs(int rate, int sample) const;
    /// The number of samples in which they run.
    int count(int rate) const { return rate == kEverySample ? samples() : rate; }
};

/// The finest raster that divides n, fits the driver, and keeps its fine pixels below 2^24: it draws triangles least
/// often.
Sampling splitSamples(int samples, glm::ivec2 size, int maxTextureSize);

}  // namespace limn
