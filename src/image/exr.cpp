#include "base/error.h"
#include "image/image.h"

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
std::string channelName(const Layer& layer, const std::string& channel) {
    return layer.name == "beauty" ? channel : layer.name + "." + channel;
}

class ExrEncoder : public ImageEncoder {
public:
    ExrEncoder(std::span<const Layer> layers, int height, const Metadata& metadata) {
        Imf::Header header(layers.front().image.width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
        for (const Layer& layer : layers)
            for (const auto& channel : layer.channels)
                header.channels().insert(channelName(layer, channel), Imf::Channel(typeOf(layer)));
        guarded([&] {
            file_ = std::make_unique<Imf::OutputFile>(
                stream_, header, static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
        });
    }

    void add(std::span<const Layer> band) override {
        Imf::FrameBuffer frame;
        std::vector<std::vector<half>> halves(band.size());
        std::vector<std::vector<std::uint32_t>> integers(band.size());
        const int height = band.front().image.height;
        for (std::size_t l = 0; l < band.size(); ++l) {
            const Layer& layer = band[l];
            const auto& pixels = layer.image.pixels;
            const char* base = reinterpret_cast<const char*>(pixels.data());
            std::size_t size = sizeof(float);
            if (layer.isColour) {
                size = sizeof(half);
                halves[l].resize(pixels.size());
                // Half ends at 65504: clamp rather than write infinity.
                std::transform(pixels.begin(), pixels.end(), halves[l].begin(),
                    [](float v) { return half(std::clamp(v, -65504.0f, 65504.0f)); });
                base = reinterpret_cast<const char*>(halves[l].data());
            } else if (layer.isInteger) {
                size = sizeof(std::uint32_t);
                integers[l].resize(pixels.size());
                std::transform(pixels.begin(), pixels.end(), integers[l].begin(),
                    [](float v) { return static_cast<std::uint32_t>(v); });
                base = reinterpret_cast<const char*>(integers[l].data());
            }
            const std::size_t step = static_cast<std::size_t>(layer.image.channels) * size,
                              row = step * static_cast<std::size_t>(layer.image.width);
            // The library counts rows from the picture's top.
            for (std::size_t c = 0; c < layer.channels.size(); ++c)
                frame.insert(channelName(layer, layer.channels[c]),
                    Imf::Slice(typeOf(layer),
                        const_cast<char*>(base) + c * size - static_cast<std::ptrdiff_t>(row) * rows_, step, row));
        }
        guarded([&] {
            file_->setFrameBuffer(frame);
            file_->writePixels(height);
        });
        rows_ += height;
    }

    std::vector<std::byte> finish() override {
        guarded([&] { file_.reset(); });
        return std::move(stream_.bytes);
    }

private:
    static Imf::PixelType typeOf(const Layer& layer) {
        return layer.isColour ? Imf::HALF : layer.isInteger ? Imf::UINT : Imf::FLOAT;
    }

    static void guarded(const auto& work) {
        try {
            work();
        } catch (const std::exception& error) {
            throw Error(ExitCode::internal, {}, fmt::format("EXR encoding failed ({})", error.what()));
        }
    }

    MemoryStream stream_;
    std::unique_ptr<Imf::OutputFile> file_;
    std::ptrdiff_t rows_ = 0;
};

std::unique_ptr<ImageEncoder> openExr(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions&) {
    return std::make_unique<ExrEncoder>(layers, height, metadata);
}

const ImageFormat kExr{{".exr"}, "linear floating point, every AOV in one file", {.isMultiLayer = true}, openExr};

}  // namespace
}  // namespace limn
