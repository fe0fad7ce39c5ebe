// What the image library's module offers.
//
// PNG goes through libspng and EXR through OpenEXR, both linked in. JPEG, TIFF and reading go through OpenImageIO,
// which pulls in hundreds of shared libraries and a fifth of a second: it lives in a module of its own that is loaded
// when something needs it.
#pragma once

#include "image/image.h"

namespace limn {

/// The functions that the OpenImageIO module offers.
struct ImageModule {
    std::unique_ptr<ImageEncoder> (*openJpeg)(const Layer&, int height, const Metadata&, const EncodeOptions&);
    std::unique_ptr<ImageEncoder> (*openTiff)(const Layer&, int height, const Metadata&, const EncodeOptions&);
    Image (*read)(const std::filesystem::path&);
    ImageInfo (*readInfo)(const std::filesystem::path&);
    std::optional<Metadata> (*readWhole)(const std::filesystem::path&);
};

/// Loads the module on first use. Throws Error (internal) when it is not beside the program.
const ImageModule& imageModule();

}  // namespace limn
