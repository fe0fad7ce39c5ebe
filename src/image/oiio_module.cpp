// The part of limn that links OpenImageIO: built as limn-oiio.so.

#include "base/error.h"
#include "image/codecs.h"
#include "settings/color.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace limn {
namespace {

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
        if (format_ == "jpeg")
            spec.attribute("Compression", fmt::format("jpeg:{}", options.quality));
        else
            spec.attribute("Compression", "zip");
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
        spec.attribute("ImageDescription", description);
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
        check(bits_ == 16 ? output_->write_scanlines(rows_, end, 0, OIIO::TypeUInt16, quantize16(*source).data())
                          : output_->write_scanlines(rows_, end, 0, OIIO::TypeUInt8, quantize8(*source).data()));
        rows_ = end;
    }

    std::vector<std::byte> finish() override {
        check(output_->close());
        const auto* bytes = reinterpret_cast<const std::byte*>(buffer_.data());
        return {bytes, bytes + buffer_.size()};
    }

private:
    void check(bool done) const {
        if (!done)
            throw Error(ExitCode::internal, {},
                fmt::format("{} encoding failed ({})", format_, output_ ? output_->geterror() : OIIO::geterror()));
    }

    std::string format_;
    int bits_, rows_ = 0;
    bool dropsAlpha_ = false;
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

}  // namespace
}  // namespace limn

extern "C" const limn::ImageModule limnImageModule{limn::openJpeg, limn::openTiff, limn::read, limn::readInfo};
