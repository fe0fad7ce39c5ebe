// Pixel formats of the images that passes exchange.
#pragma once

#include <string_view>

namespace limn {

enum class Format { r8, rgba8, r16f, r32f, rg32f, rgba16f, rgba32f, r32ui, rg32ui, depth32f, srgb8Array };

struct FormatInfo {
    std::string_view name;        ///< as plans print it
    int bytes;                    ///< per pixel
    std::string_view glslImage;   ///< layout qualifier; empty = cannot be an image
    std::string_view glslPrefix;  ///< "" or "u": of sampler and image types
    int channels;
};

constexpr FormatInfo info(Format format) {
    switch (format) {
        case Format::r8: return {"R8", 1, "r8", "", 1};
        case Format::rgba8: return {"RGBA8", 4, "rgba8", "", 4};
        case Format::r16f: return {"R16F", 2, "r16f", "", 1};
        case Format::r32f: return {"R32F", 4, "r32f", "", 1};
        case Format::rg32f: return {"RG32F", 8, "rg32f", "", 2};
        case Format::rgba16f: return {"RGBA16F", 8, "rgba16f", "", 4};
        case Format::rgba32f: return {"RGBA32F", 16, "rgba32f", "", 4};
        case Format::r32ui: return {"R32UI", 4, "r32ui", "u", 1};
        case Format::rg32ui: return {"RG32UI", 8, "rg32ui", "u", 2};
        case Format::depth32f: return {"D32F", 4, "", "", 1};
        case Format::srgb8Array: return {"SRGB8_A8", 4, "", "", 4};
    }
    return {"?", 0, "", "", 0};
}

}  // namespace limn
