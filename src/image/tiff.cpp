#include "image/codecs.h"

namespace limn {
namespace {

std::unique_ptr<ImageEncoder> openTiff(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    return imageModule().openTiff(layers.front(), height, metadata, options);
}

const ImageFormat kTiff{{".tif", ".tiff"}, "8 or 16 bits, display-encoded, lossless", {.needsLibrary = true}, openTiff};

}  // namespace
}  // namespace limn
