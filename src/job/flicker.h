// How much a sequence flickers.
//
// Pixels that show the same point of a surface in two frames should look alike, unless the light on it has changed. The
// figure of a pair of frames is the mean change of display-encoded luminance, in 1/255, over all pixels whose point (by
// the AOV `motion`) was visible a frame before, among four pixels of the same object. Lines along outlines belong to no
// point, and count as they are.
#pragma once

#include "image/image.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

struct FlickerFigure {
    double mean = 0, p99 = 0;  ///< 1/255 of display-encoded luminance
    double compared = 0;       ///< share of the picture's pixels
};

class Flicker {
public:
    /// The layers that it needs: beauty, motion and object_id. False where one is missing.
    static bool canBeSeen(std::span<const Layer> layers);

    /// The next rows of a frame, from the top.
    void add(std::span<const Layer> band);
    /// Ends a frame. Nothing for the first.
    std::optional<FlickerFigure> endFrame();
    /// Forgets the last frame: the next one does not follow it.
    void restart() { before_ = {}; }

private:
    struct Frame {
        Image luminance, motion, object;
    };
    Frame now_, before_;
};

}  // namespace limn
