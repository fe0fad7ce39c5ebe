#include "image/codecs.h"

namespace limn {
namespace {

std::unique_ptr<ImageEncoder> openJpeg(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    return imageModule().openJpeg(layers.front(), height, metadata, options);
}

const ImageFormat kJpeg{
    {".jpg", ".jpeg"}, "8 bits, display-encoded, lossy", {.needsLibrary = true, .isOpaque = true}, openJpeg};

}  // namespace
}  // namespace limn
