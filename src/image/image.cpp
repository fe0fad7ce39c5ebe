#include "image/image.h"

#include "base/color.h"
#include "base/error.h"
#include "image/codecs.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

/// Unpremultiplies, encodes and quantizes: what 8 and 16 bit files hold. Rounds to nearest.
template <class T>
std::vector<T> quantize(const Layer& layer) {
    constexpr float largest = static_cast<float>(std::numeric_limits<T>::max());
    const Image& image = layer.image;
    const int channels = image.channels;
    std::vector<T> result(image.pixels.size());
    tbb::parallel_for(0, image.height, [&](int y) {
        const float* in = image.at(0, y);
        T* out = result.data() + (in - image.pixels.data());
        for (int x = 0; x < image.width; ++x, in += channels, out += channels) {
            const bool hasAlpha = channels == 4;
            const float alpha = hasAlpha ? in[3] : 1.0f;
            for (int c = 0; c < channels; ++c) {
                float value = in[c];
                if (layer.isColour && !(hasAlpha && c == 3)) value = alpha > 0 ? linearToSrgb(value / alpha) : 0.0f;
                // A NaN compares false and becomes 0; it is counted and reported elsewhere.
                out[c] = static_cast<T>(std::lround((value > 0 ? std::min(value, 1.0f) : 0.0f) * largest));
            }
        }
    });
    return result;
}

}  // namespace

std::vector<std::uint8_t> quantize8(const Layer& layer) { return quantize<std::uint8_t>(layer); }
std::vector<std::uint16_t> quantize16(const Layer& layer) { return quantize<std::uint16_t>(layer); }

std::optional<FileFormat> fileFormat(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return FileFormat::png;
    if (extension == ".jpg" || extension == ".jpeg") return FileFormat::jpeg;
    if (extension == ".tif" || extension == ".tiff") return FileFormat::tiff;
    if (extension == ".exr") return FileFormat::exr;
    return std::nullopt;
}

std::unique_ptr<ImageEncoder> openEncoder(FileFormat format, std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    switch (format) {
        case FileFormat::png: return openPng(layers.front(), height, metadata, options);
        case FileFormat::exr: return openExr(layers, height, metadata);
        case FileFormat::jpeg: return imageModule().openJpeg(layers.front(), height, metadata, options);
        case FileFormat::tiff: return imageModule().openTiff(layers.front(), height, metadata, options);
    }
    throw Error(ExitCode::internal, {}, "unknown file format");
}

std::vector<std::byte> encodeImage(FileFormat format, std::span<const Layer> layers, const Metadata& metadata, const EncodeOptions& options) {
    const auto encoder = openEncoder(format, layers, layers.front().image.height, metadata, options);
    encoder->add(layers);
    return encoder->finish();
}

Image readImage(const std::filesystem::path& path) { return imageModule().read(path); }

}  // namespace limn
