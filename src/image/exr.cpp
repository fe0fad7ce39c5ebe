#include "base/error.h"
#include "image/codecs.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

namespace limn {
namespace {

class MemoryStream : public Imf::OStream {
public:
    MemoryStream() : OStream("memory") {}
    void write(const char c[], int n) override {
        const auto end = position_ + static_cast<std::size_t>(n);
        if (end > bytes.size()) bytes.resize(end);
        std::memcpy(bytes.data() + position_, c, static_cast<std::size_t>(n));
        position_ = end;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<std::byte> bytes;

private:
    std::size_t position_ = 0;
};

/// "R" for the beauty, "normal.X" for others: what compositing programs expect.
std::string channelName(const Layer& layer, const std::string& channel) { return layer.name == "beauty" ? channel : layer.name + "." + channel; }

/// The samples of one layer in the form the file holds.
struct Samples {
    std::vector<half> halves;
    std::vector<std::uint32_t> integers;
};

}  // namespace

std::vector<std::byte> encodeExr(std::span<const Layer> layers, const Metadata& metadata) {
    const int width = layers.front().image.width, height = layers.front().image.height;
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));

    Imf::FrameBuffer frame;
    std::vector<Samples> converted(layers.size());
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const Layer& layer = layers[l];
        const auto& pixels = layer.image.pixels;
        const char* base = reinterpret_cast<const char*>(pixels.data());
        Imf::PixelType type = Imf::FLOAT;
        std::size_t size = sizeof(float);
        if (layer.isColour) {
            type = Imf::HALF, size = sizeof(half);
            auto& halves = converted[l].halves;
            halves.resize(pixels.size());
            // Half ends at 65504: clamp rather than write infinity.
            std::transform(pixels.begin(), pixels.end(), halves.begin(), [](float v) { return half(std::clamp(v, -65504.0f, 65504.0f)); });
            base = reinterpret_cast<const char*>(halves.data());
        } else if (layer.isInteger) {
            type = Imf::UINT, size = sizeof(std::uint32_t);
            auto& integers = converted[l].integers;
            integers.resize(pixels.size());
            std::transform(pixels.begin(), pixels.end(), integers.begin(), [](float v) { return static_cast<std::uint32_t>(v); });
            base = reinterpret_cast<const char*>(integers.data());
        }
        const auto channels = static_cast<std::size_t>(layer.image.channels);
        for (std::size_t c = 0; c < channels; ++c) {
            const std::string name = channelName(layer, layer.channels[c]);
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice(type, const_cast<char*>(base) + c * size, channels * size, channels * size * static_cast<std::size_t>(width)));
        }
    }
    MemoryStream stream;
    try {
        Imf::OutputFile file(stream, header, static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
        file.setFrameBuffer(frame);
        file.writePixels(height);
    } catch (const std::exception& error) {
        throw Error(ExitCode::internal, {}, fmt::format("EXR encoding failed ({})", error.what()));
    }
    return std::move(stream.bytes);
}

}  // namespace limn
