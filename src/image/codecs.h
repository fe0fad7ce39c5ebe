// The encoders behind encodeImage.
//
// PNG goes through libspng and EXR through OpenEXR, both linked in. JPEG, TIFF and reading go through OpenImageIO, which pulls in
// hundreds of shared libraries and a fifth of a second: it lives in a module of its own that is loaded when something needs it.
#pragma once

#include "image/image.h"

namespace limn {

std::vector<std::byte> encodePng(const Layer& layer, const Metadata& metadata, const EncodeOptions& options);
std::vector<std::byte> encodeExr(std::span<const Layer> layers, const Metadata& metadata);

/// The functions that the OpenImageIO module offers.
struct ImageModule {
    std::vector<std::byte> (*encodeJpeg)(const Layer&, const Metadata&, const EncodeOptions&);
    std::vector<std::byte> (*encodeTiff)(const Layer&, const Metadata&, const EncodeOptions&);
    Image (*read)(const std::filesystem::path&);
};

/// Loads the module on first use. Throws Error (internal) when it is not beside the program.
const ImageModule& imageModule();

}  // namespace limn
