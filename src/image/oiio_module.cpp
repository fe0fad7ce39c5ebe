// The part of limn that links OpenImageIO: built as limn-oiio.so.

#include "base/color.h"
#include "base/error.h"
#include "image/codecs.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace limn {
namespace {

std::vector<std::byte> encode(const char* format, const Layer& layer, const Metadata& metadata, const EncodeOptions& options, int bits) {
    Layer opaque;
    const Layer* source = &layer;
    if (layer.image.channels == 4 && std::string_view(format) == "jpeg") {  // JPEG has no alpha: what is left of the colour over black
        opaque = layer;
        opaque.image = {layer.image.width, layer.image.height, 3, {}};
        for (std::size_t i = 0; i < layer.image.pixels.size(); ++i)
            if (i % 4 != 3) opaque.image.pixels.push_back(layer.image.pixels[i]);
        source = &opaque;
    }
    const Image& image = source->image;
    OIIO::ImageSpec spec(image.width, image.height, image.channels, bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", source->isColour ? "sRGB" : "Linear");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    // The TIFF writer would put the present time: the same input must give the same bytes.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    if (std::string_view(format) == "jpeg") spec.attribute("Compression", fmt::format("jpeg:{}", options.quality));
    else spec.attribute("Compression", "zip");
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

    std::vector<unsigned char> buffer;
    OIIO::Filesystem::IOVecOutput proxy(buffer);
    const auto output = OIIO::ImageOutput::create(format, &proxy);
    const auto fail = [&] { throw Error(ExitCode::internal, {}, fmt::format("{} encoding failed ({})", format, output ? output->geterror() : OIIO::geterror())); };
    if (!output || !output->open(std::string("memory.") + format, spec)) fail();
    const bool written = bits == 16 ? output->write_image(OIIO::TypeUInt16, quantize16(*source).data()) : output->write_image(OIIO::TypeUInt8, quantize8(*source).data());
    if (!written || !output->close()) fail();
    const auto* bytes = reinterpret_cast<const std::byte*>(buffer.data());
    return {bytes, bytes + buffer.size()};
}

std::vector<std::byte> encodeJpeg(const Layer& layer, const Metadata& metadata, const EncodeOptions& options) { return encode("jpeg", layer, metadata, options, 8); }
std::vector<std::byte> encodeTiff(const Layer& layer, const Metadata& metadata, const EncodeOptions& options) { return encode("tiff", layer, metadata, options, options.bits); }

Image read(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& why) { throw Error(ExitCode::badData, {path.string()}, fmt::format("the image cannot be read ({})", why), "save it again as PNG, JPEG, TIFF or EXR"); };
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path.string(), &hints);
    if (!input) fail(OIIO::geterror());
    const auto& spec = input->spec();
    constexpr int kLargest = 1 << 16;
    if (spec.width < 1 || spec.height < 1 || spec.width > kLargest || spec.height > kLargest || spec.nchannels < 1) fail("unusable size");
    Image image{spec.width, spec.height, std::min(spec.nchannels, 4), {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * static_cast<std::size_t>(image.channels));
    if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeFloat, image.pixels.data())) fail(input->geterror());
    // Integer pictures are display-encoded unless they say otherwise; float pictures are linear.
    const auto space = spec.get_string_attribute("oiio:ColorSpace", spec.format.is_floating_point() ? "Linear" : "sRGB");
    const int colours = image.channels >= 3 ? 3 : 1;
    if (OIIO::Strutil::iequals(space, "sRGB") || !spec.format.is_floating_point())
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            if (static_cast<int>(i % static_cast<std::size_t>(image.channels)) < colours) image.pixels[i] = srgbToLinear(image.pixels[i]);
    return image;
}

}  // namespace
}  // namespace limn

extern "C" const limn::ImageModule limnImageModule{limn::encodeJpeg, limn::encodeTiff, limn::read};
