// What encoders of vector formats share: a drawing, and the picture below it as a PNG that grows band by band.
#pragma once

#include "base/error.h"
#include "drawing/drawing.h"

namespace limn {

class VectorEncoder : public ImageEncoder {
public:
    /// Throws Error (internal) without a drawing.
    VectorEncoder(std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options)
        : drawing_(std::static_pointer_cast<const Drawing>(options.vectors)), metadata_(metadata), options_(options) {
        if (!drawing_)
            throw Error(ExitCode::internal, {}, "a vector file is written without a drawing", "please report this");
        if (options_.underlay) picture_ = imageFormat("picture.png")->open(layers, height, {}, options_);
    }
    void add(std::span<const Layer> band) override {
        if (picture_) picture_->add(band);
    }

protected:
    std::shared_ptr<const Drawing> drawing_;
    Metadata metadata_;
    EncodeOptions options_;
    std::unique_ptr<ImageEncoder> picture_;  ///< null: no picture lies below the lines
};

}  // namespace limn
