// PPM: three display-encoded bytes a pixel behind a line of text. Alpha is left out.

#include "image/image.h"

#include <fmt/format.h>

namespace limn {
namespace {

class PpmEncoder : public ImageEncoder {
public:
    PpmEncoder(int width, int height) { add(fmt::format("P6\n{} {}\n255\n", width, height)); }

    void add(std::span<const Layer> band) override {
        const Layer& layer = band.front();
        const auto values = quantize8(layer);
        const auto channels = static_cast<std::size_t>(layer.image.channels);
        for (std::size_t at = 0; at < values.size(); at += channels)
            for (std::size_t k = 0; k < 3; ++k) bytes_.push_back(std::byte{values[at + std::min(k, channels - 1)]});
    }
    std::vector<std::byte> finish() override { return std::move(bytes_); }

private:
    void add(const std::string& text) {
        for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
    }
    std::vector<std::byte> bytes_;
};

std::unique_ptr<ImageEncoder> openPpm(
    std::span<const Layer> layers, int height, const Metadata&, const EncodeOptions&) {
    return std::make_unique<PpmEncoder>(layers.front().image.width, height);
}

const ImageFormat kPpm{{".ppm"}, "8 bits, display-encoded, uncompressed", {}, openPpm};

}  // namespace
}  // namespace limn
