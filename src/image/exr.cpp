#include "base/content_key.h"
#include "base/error.h"
#include "base/file.h"
#include "image/image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
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

/// The bytes of a file that is in memory.
class MemoryInput : public Imf::IStream {
public:
    explicit MemoryInput(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        const auto count = static_cast<std::size_t>(n);
        if (count > bytes_.size() - position_) throw std::runtime_error("the file ends early");
        std::memcpy(c, bytes_.data() + position_, count);
        position_ += count;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = std::min<std::uint64_t>(position, bytes_.size()); }

private:
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

/// "R" for the beauty, "normal.X" for others: what compositing programs expect.
std::string channelName(const Layer& layer, const std::string& channel) {
    return layer.name == "beauty" ? channel : layer.name + "." + channel;
}

Imf::PixelType typeOf(const Layer& layer) {
    return layer.isColour ? Imf::HALF : layer.isInteger ? Imf::UINT : Imf::FLOAT;
}

/// Rows of a layer as they are in the file: channels interleaved.
struct Samples {
    Imf::PixelType type;
    std::size_t pixel, row;  ///< bytes
    std::vector<std::byte> bytes;

    Samples(const Layer& layer, int height)
        : type(typeOf(layer)),
          pixel(layer.channels.size() * (type == Imf::HALF ? sizeof(half) : sizeof(float))),
          row(pixel * static_cast<std::size_t>(layer.image.width)),
          bytes(row * static_cast<std::size_t>(height)) {}

    /// Tells the library where the rows from `top` are; it counts rows from the picture's.
    void insertInto(Imf::FrameBuffer& frame, const Layer& layer, std::ptrdiff_t top) {
        char* const base = reinterpret_cast<char*>(bytes.data()) - static_cast<std::ptrdiff_t>(row) * top;
        for (std::size_t c = 0; c < layer.channels.size(); ++c)
            frame.insert(channelName(layer, layer.channels[c]),
                Imf::Slice(type, base + c * (pixel / layer.channels.size()), pixel, row));
    }
};

Samples samplesOf(const Layer& layer) {
    Samples result(layer, layer.image.height);
    const auto& pixels = layer.image.pixels;
    switch (result.type) {
        case Imf::HALF:
            // Half ends at 65504: clamp rather than write infinity.
            std::transform(pixels.begin(), pixels.end(), reinterpret_cast<half*>(result.bytes.data()),
                [](float v) { return half(std::clamp(v, -65504.0f, 65504.0f)); });
            break;
        case Imf::UINT:
            std::transform(pixels.begin(), pixels.end(), reinterpret_cast<std::uint32_t*>(result.bytes.data()),
                [](float v) { return static_cast<std::uint32_t>(v); });
            break;
        default: std::memcpy(result.bytes.data(), pixels.data(), result.bytes.size());
    }
    return result;
}

int threads() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

class ExrEncoder : public ImageEncoder {
public:
    ExrEncoder(std::span<const Layer> layers, int height, const Metadata& metadata)
        : height_(height), written_(layers.size()) {
        Imf::Header header(layers.front().image.width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
        for (const Layer& layer : layers) {
            layers_.push_back({layer.name, layer.channels, layer.isColour, layer.isInteger,
                {layer.image.width, 0, layer.image.channels, {}}});
            for (const auto& channel : layer.channels)
                header.channels().insert(channelName(layer, channel), Imf::Channel(typeOf(layer)));
        }
        guarded([&] { file_ = std::make_unique<Imf::OutputFile>(stream_, header, threads()); });
    }

    void add(std::span<const Layer> band) override {
        Imf::FrameBuffer frame;
        std::vector<Samples> samples;
        const int height = band.front().image.height;
        for (std::size_t l = 0; l < band.size(); ++l) {
            samples.push_back(samplesOf(band[l]));
            samples[l].insertInto(frame, band[l], rows_);
            written_[l].bytes(samples[l].bytes.data(), samples[l].bytes.size());
        }
        guarded([&] {
            file_->setFrameBuffer(frame);
            file_->writePixels(height);
        });
        rows_ += height;
    }

    std::vector<std::byte> finish() override {
        bool isSame = false;
        guarded([&] {
            file_.reset();
            isSame = holdsWhatWasWritten();
        });
        if (!isSame) throw notWhatWasWritten("EXR");
        return std::move(stream_.bytes);
    }

private:
    bool holdsWhatWasWritten() const {
        constexpr int kRows = 64;  // at a time: four of the blocks that ZIP makes
        MemoryInput stream(stream_.bytes);
        Imf::InputFile file(stream, threads());
        std::vector<Samples> samples;
        std::vector<KeyBuilder> read(layers_.size());
        for (const Layer& layer : layers_) samples.emplace_back(layer, kRows);
        for (int y = 0; y < height_; y += kRows) {
            const int rows = std::min(kRows, height_ - y);
            Imf::FrameBuffer frame;
            for (std::size_t l = 0; l < layers_.size(); ++l) samples[l].insertInto(frame, layers_[l], y);
            file.setFrameBuffer(frame);
            file.readPixels(y, y + rows - 1);
            for (std::size_t l = 0; l < layers_.size(); ++l)
                read[l].bytes(samples[l].bytes.data(), samples[l].row * static_cast<std::size_t>(rows));
        }
        return std::equal(written_.begin(), written_.end(), read.begin(),
            [](const KeyBuilder& a, const KeyBuilder& b) { return a.key() == b.key(); });
    }

    static void guarded(const auto& work) {
        try {
            work();
        } catch (const std::exception& error) {
            throw Error(ExitCode::internal, {}, fmt::format("EXR encoding failed ({})", error.what()));
        }
    }

    int height_;
    std::vector<Layer> layers_;  ///< without pixels
    std::vector<KeyBuilder> written_;
    MemoryStream stream_;
    std::unique_ptr<Imf::OutputFile> file_;
    std::ptrdiff_t rows_ = 0;
};

std::unique_ptr<ImageEncoder> openExr(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions&) {
    return std::make_unique<ExrEncoder>(layers, height, metadata);
}

/// Decodes all pixels, some rows at a time; throws what the library throws.
void decodeAll(Imf::InputFile& file) {
    constexpr int kRows = 64;
    const auto& window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    std::vector<char> values(width * kRows * sizeof(float));  // one channel after the other, over the last
    for (int y = window.min.y; y <= window.max.y; y += kRows) {
        Imf::FrameBuffer frame;
        const auto& channels = file.header().channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            const std::size_t size = channel.channel().type == Imf::HALF ? sizeof(half) : sizeof(float);
            char* const base = values.data()
                - (static_cast<std::ptrdiff_t>(width) * y + window.min.x) * static_cast<std::ptrdiff_t>(size);
            frame.insert(channel.name(), Imf::Slice(channel.channel().type, base, size, width * size));
        }
        file.setFrameBuffer(frame);
        file.readPixels(y, std::min(y + kRows - 1, window.max.y));
    }
}

std::optional<Metadata> readWholeExr(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    try {
        MemoryInput stream(std::as_bytes(std::span(mapped.text())));
        Imf::InputFile file(stream, threads());
        Metadata texts;
        for (auto one = file.header().begin(); one != file.header().end(); ++one)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&one.attribute()))
                texts.emplace_back(one.name(), text->value());
        decodeAll(file);
        return texts;
    } catch (const std::exception&) { return std::nullopt; }
}

const ImageFormat kExr{
    {".exr"}, "linear floating point, every AOV in one file", {.isMultiLayer = true}, openExr, readWholeExr};

}  // namespace
}  // namespace limn
