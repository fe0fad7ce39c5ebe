#include "image/image.h"

#include "base/error.h"
#include "base/in_order.h"
#include "base/text.h"
#include "image/codecs.h"
#include "settings/color.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

namespace limn {
namespace {

/// Linear 0 … 1 → 8 display-encoded bits, rounded to nearest: what linearToSrgb() gives, by where its steps are instead
/// of a power per channel.
class EightBits {
public:
    EightBits() {
        least_[0] = 0;
        for (int code = 1; code < 256; ++code) {
            // The least float that rounds to the code: bits of positive floats are in the order of their values.
            std::uint32_t below = std::bit_cast<std::uint32_t>(least_[static_cast<std::size_t>(code - 1)]),
                          reached = std::bit_cast<std::uint32_t>(1.0f);
            while (reached - below > 1) {
                const std::uint32_t middle = below + (reached - below) / 2;
                (std::lround(linearToSrgb(std::bit_cast<float>(middle)) * 255) >= code ? reached : below) = middle;
            }
            least_[static_cast<std::size_t>(code)] = std::bit_cast<float>(reached);
        }
        least_[256] = std::numeric_limits<float>::infinity();
        for (std::size_t cell = 0, code = 0; cell < first_.size(); ++cell) {
            while (least_[code + 1] <= static_cast<float>(cell) / kCells) ++code;
            first_[cell] = static_cast<std::uint8_t>(code);
        }
    }

    std::uint8_t operator()(float value) const {
        std::size_t code = first_[static_cast<std::size_t>(value * kCells)];
        while (value >= least_[code + 1]) ++code;  // once at most: cells are narrower than the narrowest step
        return static_cast<std::uint8_t>(code);
    }

private:
    static constexpr int kCells = 4096;
    std::array<float, 257> least_;
    std::array<std::uint8_t, kCells + 1> first_;
};

/// Unpremultiplies, encodes and quantizes: what 8 and 16 bit files hold. Rounds to nearest.
template <class T>
void quantizeRow(const Layer& layer, int y, T* out) {
    constexpr float largest = static_cast<float>(std::numeric_limits<T>::max());
    const Image& image = layer.image;
    const int channels = image.channels;
    static const EightBits eightBits;
    const float* in = image.at(0, y);
    for (int x = 0; x < image.width; ++x, in += channels, out += channels) {
        const bool hasAlpha = channels == 4;
        const float alpha = hasAlpha ? in[3] : 1.0f;
        for (int c = 0; c < channels; ++c) {
            float value = in[c];
            const bool isEncoded = layer.isColour && !(hasAlpha && c == 3);
            if (isEncoded) value = alpha > 0 ? value / alpha : 0.0f;
            // A NaN compares false and becomes 0; it is counted and reported elsewhere.
            value = value > 0 ? std::min(value, 1.0f) : 0.0f;
            if (isEncoded && std::is_same_v<T, std::uint8_t>)
                out[c] = eightBits(value);
            else
                out[c] = static_cast<T>(std::lround((isEncoded ? linearToSrgb(value) : value) * largest));
        }
    }
}

template <class T>
std::vector<T> quantize(const Layer& layer) {
    std::vector<T> result(layer.image.pixels.size());
    tbb::parallel_for(0, layer.image.height,
        [&](int y) { quantizeRow(layer, y, result.data() + (layer.image.at(0, y) - layer.image.pixels.data())); });
    return result;
}

template <class T>
void quantizeRows(const Layer& layer, const std::function<void(const T*)>& take) {
    constexpr int kRows = 8;  // at a time
    const Image& image = layer.image;
    const std::size_t length = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    std::vector<std::vector<T>> parts(static_cast<std::size_t>((image.height + kRows - 1) / kRows));
    const auto rowsOf = [&](std::size_t i) { return std::min(kRows, image.height - static_cast<int>(i) * kRows); };
    inOrder(
        parts.size(),
        [&](std::size_t i) {
            parts[i].resize(length * static_cast<std::size_t>(rowsOf(i)));
            for (int row = 0; row < rowsOf(i); ++row)
                quantizeRow(
                    layer, static_cast<int>(i) * kRows + row, parts[i].data() + length * static_cast<std::size_t>(row));
        },
        [&](std::size_t i) {
            for (int row = 0; row < rowsOf(i); ++row) take(parts[i].data() + length * static_cast<std::size_t>(row));
            parts[i] = {};
        });
}

}  // namespace

std::vector<std::uint8_t> quantize8(const Layer& layer) { return quantize<std::uint8_t>(layer); }
std::vector<std::uint16_t> quantize16(const Layer& layer) { return quantize<std::uint16_t>(layer); }
void quantizeRows8(const Layer& layer, const std::function<void(const std::uint8_t*)>& take) {
    quantizeRows(layer, take);
}
void quantizeRows16(const Layer& layer, const std::function<void(const std::uint16_t*)>& take) {
    quantizeRows(layer, take);
}

namespace {

std::vector<const ImageFormat*>& registry() {
    static std::vector<const ImageFormat*> formats;
    return formats;
}

}  // namespace

ImageFormat::ImageFormat(
    std::vector<std::string_view> extensions_, std::string_view doc_, Traits traits_, Open open_, ReadWhole readWhole_)
    : extensions(std::move(extensions_)), doc(doc_), traits(traits_), open(open_), readWhole(readWhole_) {
    const auto before = [](auto* a, auto* b) { return a->extensions.front() < b->extensions.front(); };
    registry().insert(std::upper_bound(registry().begin(), registry().end(), this, before), this);
}

const ImageFormat* imageFormat(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().string());
    for (const auto* format : registry())
        if (std::find(format->extensions.begin(), format->extensions.end(), extension) != format->extensions.end())
            return format;
    return nullptr;
}

std::string imageExtensions() {
    std::vector<std::string> names;
    for (const auto* format : registry()) names.emplace_back(format->extensions.front());
    return joinOr(names);
}

Error notWhatWasWritten(std::string_view format) {
    return {ExitCode::internal, {}, fmt::format("the {} file does not decode to the picture that went into it", format),
        "nothing was written; try again, and report it if it happens twice"};
}

std::vector<std::byte> encodeImage(
    const ImageFormat& format, std::span<const Layer> layers, const Metadata& metadata, const EncodeOptions& options) {
    const auto encoder = format.open(layers, layers.front().image.height, metadata, options);
    encoder->add(layers);
    return encoder->finish();
}

Image readImage(const std::filesystem::path& path) { return imageModule().read(path); }

ImageInfo readImageInfo(const std::filesystem::path& path) { return imageModule().readInfo(path); }

std::optional<Metadata> readWholePicture(const std::filesystem::path& path) {
    const ImageFormat* format = imageFormat(path);
    return format && format->readWhole ? format->readWhole(path) : imageModule().readWhole(path);
}

}  // namespace limn
