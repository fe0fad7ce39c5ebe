// The part of limn that links OpenImageIO: built as limn-oiio.so.

#include "base/content_key.h"
#include "base/error.h"
#include "image/codecs.h"
#include "settings/color.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

namespace limn {
namespace {

/// The content key of a JPEG's rows, decoded some at a time; nullopt unless there are so many.
std::optional<ContentKey> decodedJpeg(std::span<const unsigned char> file, int height) {
    constexpr int kRows = 64;
    OIIO::Filesystem::IOMemReader reader(const_cast<unsigned char*>(file.data()), file.size());
    const auto input = OIIO::ImageInput::open("memory.jpeg", nullptr, &reader);
    if (!input || input->spec().height != height) return std::nullopt;
    const auto& spec = input->spec();
    std::vector<std::byte> samples(spec.scanline_bytes() * kRows);
    KeyBuilder rows;
    for (int y = 0; y < height; y += kRows) {
        const int end = std::min(y + kRows, height);
        if (!input->read_scanlines(0, 0, y, end, 0, 0, spec.nchannels, OIIO::TypeUInt8, samples.data()))
            return std::nullopt;
        rows.bytes(samples.data(), spec.scanline_bytes() * static_cast<std::size_t>(end - y));
    }
    return rows.key();
}

/// A TIFF in memory, as libtiff reads files. (OpenImageIO 2.4 reads TIFF from the disk only.)
struct TiffMemory {
    std::span<const unsigned char> file;
    std::uint64_t position = 0;
};

tmsize_t readTiff(thandle_t handle, void* to, tmsize_t size) {
    auto& memory = *static_cast<TiffMemory*>(handle);
    const std::uint64_t from = std::min<std::uint64_t>(memory.position, memory.file.size()),
                        count = std::min<std::uint64_t>(static_cast<std::uint64_t>(size), memory.file.size() - from);
    std::memcpy(to, memory.file.data() + from, count);
    memory.position = from + count;
    return static_cast<tmsize_t>(count);
}

toff_t seekTiff(thandle_t handle, toff_t offset, int from) {
    auto& memory = *static_cast<TiffMemory*>(handle);
    const std::uint64_t base = from == SEEK_SET ? 0 : from == SEEK_CUR ? memory.position : memory.file.size();
    return memory.position = base + offset;
}

/// As decodedJpeg().
std::optional<ContentKey> decodedTiff(std::span<const unsigned char> file, int height) {
    TiffMemory memory{file};
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(
        TIFFClientOpen(
            "memory", "rm", &memory, readTiff, [](thandle_t, void*, tmsize_t) { return tmsize_t{0}; }, seekTiff,
            [](thandle_t) { return 0; },
            [](thandle_t handle) -> toff_t { return static_cast<TiffMemory*>(handle)->file.size(); }, nullptr, nullptr),
        [](TIFF* open) {
            if (open) TIFFClose(open);
        });
    std::uint32_t rows = 0;
    if (!tiff || TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &rows) != 1
        || rows != static_cast<std::uint32_t>(height))
        return std::nullopt;
    std::vector<std::byte> row(static_cast<std::size_t>(TIFFScanlineSize(tiff.get())));
    KeyBuilder key;
    for (std::uint32_t y = 0; y < rows; ++y) {
        if (TIFFReadScanline(tiff.get(), row.data(), y, 0) != 1) return std::nullopt;
        key.bytes(row.data(), row.size());
    }
    return key.key();
}

class OiioEncoder : public ImageEncoder {
public:
    OiioEncoder(const char* format, const Layer& layer, int height, const Metadata& metadata,
        const EncodeOptions& options, int bits)
        : format_(format), bits_(bits), proxy_(buffer_) {
        dropsAlpha_ =
            layer.image.channels == 4 && format_ == "jpeg";  // JPEG has none: what is left of the colour over black
        OIIO::ImageSpec spec(layer.image.width, height, dropsAlpha_ ? 3 : layer.image.channels,
            bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
        // OpenImageIO 2.4 writes TIFF's colour space into an EXIF directory, which, in memory, costs the image's own.
        if (format_ != "tiff") spec.attribute("oiio:ColorSpace", layer.isColour ? "sRGB" : "Linear");
        spec.attribute("oiio:UnassociatedAlpha", 1);
        // The TIFF writer would put the present time: the same input must give the same bytes.
        spec.attribute("DateTime", "1970:01:01 00:00:00");
        if (format_ == "jpeg") {
            spec.attribute("Compression", fmt::format("jpeg:{}", options.quality));
            spec.attribute("jpeg:subsampling", "4:4:4");  // halved colours would smear coloured lines
        } else {
            spec.attribute("Compression", "zip");
        }
        if (options.dpi > 0) {
            spec.attribute("ResolutionUnit", "in");
            spec.attribute("XResolution", static_cast<float>(options.dpi));
            spec.attribute("YResolution", static_cast<float>(options.dpi));
        }
        std::string description;
        for (const auto& [key, value] : metadata) {
            description += fmt::format("{}: {}\n", key, value);
            if (key == "Software") spec.attribute("Software", value);
        }
        // The library stumbles over an empty one.
        if (!description.empty()) spec.attribute("ImageDescription", description);
        output_ = OIIO::ImageOutput::create(format_, &proxy_);
        check(output_ && output_->open("memory." + format_, spec));
    }

    void add(std::span<const Layer> band) override {
        Layer opaque;
        const Layer* source = &band.front();
        if (dropsAlpha_) {
            opaque = *source;
            opaque.image = {source->image.width, source->image.height, 3, {}};
            for (std::size_t i = 0; i < source->image.pixels.size(); ++i)
                if (i % 4 != 3) opaque.image.pixels.push_back(source->image.pixels[i]);
            source = &opaque;
        }
        const int end = rows_ + source->image.height;
        if (bits_ == 16)
            write(quantize16(*source), OIIO::TypeUInt16, end);
        else
            write(quantize8(*source), OIIO::TypeUInt8, end);
        rows_ = end;
    }

    std::vector<std::byte> finish() override {
        check(output_->close());
        verify();
        const auto* bytes = reinterpret_cast<const std::byte*>(buffer_.data());
        return {bytes, bytes + buffer_.size()};
    }

private:
    template <class T>
    void write(const std::vector<T>& samples, const OIIO::TypeDesc& type, int end) {
        written_.bytes(samples.data(), samples.size() * sizeof(T));
        check(output_->write_scanlines(rows_, end, 0, type, samples.data()));
    }

    void verify() const {
        const std::span file(buffer_);
        const auto read = format_ == "tiff" ? decodedTiff(file, rows_) : decodedJpeg(file, rows_);
        if (!read || (format_ == "tiff" && *read != written_.key())) throw notWhatWasWritten(format_);
    }

    void check(bool done) const {
        if (!done)
            throw Error(ExitCode::internal, {},
                fmt::format("{} encoding failed ({})", format_, output_ ? output_->geterror() : OIIO::geterror()));
    }

    std::string format_;
    int bits_, rows_ = 0;
    bool dropsAlpha_ = false;
    KeyBuilder written_;
    std::vector<unsigned char> buffer_;
    OIIO::Filesystem::IOVecOutput proxy_;
    std::unique_ptr<OIIO::ImageOutput> output_;
};

std::unique_ptr<ImageEncoder> openJpeg(
    const Layer& layer, int height, const Metadata& metadata, const EncodeOptions& options) {
    return std::make_unique<OiioEncoder>("jpeg", layer, height, metadata, options, 8);
}
std::unique_ptr<ImageEncoder> openTiff(
    const Layer& layer, int height, const Metadata& metadata, const EncodeOptions& options) {
    return std::make_unique<OiioEncoder>("tiff", layer, height, metadata, options, options.bits);
}

[[noreturn]] void fail(const std::filesystem::path& path, std::string why) {
    // The library names the file itself, and says things over several lines.
    why = why.substr(0, why.find('\n'));
    if (const auto own = why.find(" (\"" + path.string()); own != std::string::npos) why.resize(own);
    throw Error(ExitCode::badData, {path.string()}, fmt::format("the image cannot be read ({})", why),
        "save it again as PNG, JPEG, TIFF or EXR");
}

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& path) {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    auto input = OIIO::ImageInput::open(path.string(), &hints);
    if (!input) fail(path, OIIO::geterror());
    const auto& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) fail(path, "it has no pixels");
    if (std::int64_t{spec.width} * spec.height > kMostPixels)
        throw Error(ExitCode::outOfMemory, {path.string()},
            fmt::format("the image has {}×{} pixels, more than the {} million that limn reads", spec.width, spec.height,
                kMostPixels >> 20),
            "make it smaller");
    return input;
}

ImageInfo readInfo(const std::filesystem::path& path) {
    const auto input = open(path);
    const auto& spec = input->spec();
    return {spec.width, spec.height, spec.nchannels};
}

Image read(const std::filesystem::path& path) {
    const auto input = open(path);
    const auto& spec = input->spec();
    Image image{spec.width, spec.height, std::min(spec.nchannels, 4), {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)
        * static_cast<std::size_t>(image.channels));
    if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeFloat, image.pixels.data()))
        fail(path, input->geterror());
    // Integer pictures are display-encoded unless they say otherwise; float pictures are linear.
    const auto space =
        spec.get_string_attribute("oiio:ColorSpace", spec.format.is_floating_point() ? "Linear" : "sRGB");
    const int colours = image.channels >= 3 ? 3 : 1;
    if (OIIO::Strutil::iequals(space, "sRGB") || !spec.format.is_floating_point())
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            if (static_cast<int>(i % static_cast<std::size_t>(image.channels)) < colours)
                image.pixels[i] = srgbToLinear(image.pixels[i]);
    return image;
}

/// JPEG readers make up what is missing: the end of the file must be there.
bool endsAsJpeg(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 2> end{};
    return file.seekg(-2, std::ios::end) && file.read(end.data(), 2) && end[0] == '\xff' && end[1] == '\xd9';
}

/// TIFF readers do without the last bytes of a strip: all of each must be there.
bool endsAsTiff(const std::filesystem::path& path) {
    std::error_code unknown;
    const std::uint64_t size = std::filesystem::file_size(path, unknown);
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "rm"), [](TIFF* open) {
        if (open) TIFFClose(open);
    });
    if (!tiff || unknown) return false;
    for (std::uint32_t strip = 0; strip < TIFFNumberOfStrips(tiff.get()); ++strip)
        if (TIFFGetStrileOffset(tiff.get(), strip) + TIFFGetStrileByteCount(tiff.get(), strip) > size) return false;
    return true;
}

std::optional<Metadata> readWhole(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) {
        static_cast<void>(OIIO::geterror());  // forgets it
        return std::nullopt;
    }
    const auto& spec = input->spec();
    constexpr int kRows = 64;
    std::vector<std::byte> samples(spec.scanline_bytes(true) * kRows);
    for (int y = spec.y; y < spec.y + spec.height; y += kRows)
        if (!input->read_scanlines(0, 0, y, std::min(y + kRows, spec.y + spec.height), 0, 0, spec.nchannels,
                OIIO::TypeUnknown, samples.data())) {
            static_cast<void>(input->geterror());
            return std::nullopt;
        }
    const std::string_view format = input->format_name();
    if ((format == "jpeg" && !endsAsJpeg(path)) || (format == "tiff" && !endsAsTiff(path))) return std::nullopt;
    Metadata texts;
    for (const auto& attribute : spec.extra_attribs) {
        if (attribute.type() != OIIO::TypeString) continue;
        texts.emplace_back(attribute.name().string(), attribute.get_string());
        if (attribute.name() != "ImageDescription") continue;
        std::istringstream lines(attribute.get_string());
        for (std::string line; std::getline(lines, line);)
            if (const auto colon = line.find(": "); colon != std::string::npos)
                texts.emplace_back(line.substr(0, colon), line.substr(colon + 2));
    }
    return texts;
}

}  // namespace
}  // namespace limn

extern "C" const limn::ImageModule limnImageModule{
    limn::openJpeg, limn::openTiff, limn::read, limn::readInfo, limn::readWhole};
