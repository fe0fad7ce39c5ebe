#include "base/content_key.h"
#include "base/error.h"
#include "base/file.h"
#include "image/image.h"

#include <fmt/format.h>
#include <spng.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace limn {

namespace {

void check(int status) {
    if (status != 0)
        throw Error(status == SPNG_EMEM ? ExitCode::outOfMemory : ExitCode::internal, {},
            fmt::format("PNG encoding failed ({})", spng_strerror(status)));
}

/// The content key of a PNG's rows, decoded one by one.
ContentKey decodedRows(std::span<const std::byte> bytes) {
    const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(0), spng_ctx_free);
    check(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
    spng_ihdr header{};
    check(spng_get_ihdr(context.get(), &header));
    std::size_t size = 0;
    check(spng_decoded_image_size(context.get(), SPNG_FMT_PNG, &size));
    check(spng_decode_image(context.get(), nullptr, 0, SPNG_FMT_PNG, SPNG_DECODE_PROGRESSIVE));
    std::vector<std::byte> row(size / header.height);
    KeyBuilder rows;
    for (std::uint32_t y = 0; y < header.height; ++y) {
        const int status = spng_decode_row(context.get(), row.data(), row.size());
        if (y + 1 < header.height || status != SPNG_EOI) check(status);
        rows.bytes(row.data(), row.size());
    }
    return rows.key();
}

class PngEncoder : public ImageEncoder {
public:
    PngEncoder(const Layer& layer, int height, const Metadata& metadata, const EncodeOptions& options)
        : bits_(options.bits), height_(height), context_(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free) {
        constexpr std::uint8_t colorTypes[] = {0, SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA,
            SPNG_COLOR_TYPE_TRUECOLOR, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
        spng_ihdr header{};
        header.width = static_cast<std::uint32_t>(layer.image.width);
        header.height = static_cast<std::uint32_t>(height);
        header.bit_depth = static_cast<std::uint8_t>(options.bits);
        header.color_type = colorTypes[layer.image.channels];
        check(spng_set_option(context_.get(), SPNG_ENCODE_TO_BUFFER, 1));
        check(spng_set_option(context_.get(), SPNG_IMG_COMPRESSION_LEVEL, options.compression));
        // Measured on pictures of all kinds: flat stylized colours compress best as they are, smooth numbers by what
        // changed from the row before. To choose anew for each row takes twice the time, and wins something at high
        // levels only.
        check(spng_set_option(context_.get(), SPNG_FILTER_CHOICE,
            options.compression > 2 ? SPNG_FILTER_CHOICE_ALL
                : layer.isColour    ? SPNG_DISABLE_FILTERING
                                    : SPNG_FILTER_CHOICE_UP));
        check(spng_set_ihdr(context_.get(), &header));
        if (layer.isColour) check(spng_set_srgb(context_.get(), 0));
        if (options.dpi > 0) {
            const auto perMetre = static_cast<std::uint32_t>(std::lround(options.dpi / 0.0254));
            spng_phys phys{perMetre, perMetre, 1};
            check(spng_set_phys(context_.get(), &phys));
        }
        std::vector<spng_text> texts;
        for (const auto& [key, value] : metadata) {
            spng_text text{};
            std::strncpy(text.keyword, key.c_str(), sizeof text.keyword - 1);
            text.type = SPNG_TEXT;
            text.text = const_cast<char*>(value.c_str());
            text.length = value.size();
            texts.push_back(text);
        }
        // Copied at the header's writing, which the first call below is.
        if (!texts.empty())
            check(spng_set_text(context_.get(), texts.data(), static_cast<std::uint32_t>(texts.size())));
        check(spng_encode_image(
            context_.get(), nullptr, 0, SPNG_FMT_PNG, SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE));
    }

    void add(std::span<const Layer> band) override {
        const Image& image = band.front().image;
        const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
        const auto write = [&](const auto* pixels) {
            written_.bytes(pixels, row * sizeof(*pixels));
            const int status = spng_encode_row(context_.get(), pixels, row * sizeof(*pixels));
            if (++rows_ < height_ || status != SPNG_EOI) check(status);
        };
        if (bits_ == 16)
            quantizeRows16(band.front(), write);
        else
            quantizeRows8(band.front(), write);
    }

    std::vector<std::byte> finish() override {
        std::size_t size = 0;
        int status = 0;
        const std::unique_ptr<void, void (*)(void*)> buffer(
            spng_get_png_buffer(context_.get(), &size, &status), std::free);
        check(status);
        const auto* bytes = static_cast<const std::byte*>(buffer.get());
        if (decodedRows({bytes, size}) != written_.key()) throw notWhatWasWritten("PNG");
        return {bytes, bytes + size};
    }

private:
    int bits_, height_, rows_ = 0;
    KeyBuilder written_;
    std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context_;
};

std::unique_ptr<ImageEncoder> openPng(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    return std::make_unique<PngEncoder>(layers.front(), height, metadata, options);
}

/// Not by the image library, whose PNG reader tells standard error what it thinks of a cut file.
std::optional<Metadata> readWholePng(const std::filesystem::path& path) {
    const MappedFile file(path);
    constexpr std::string_view end("\0\0\0\0IEND\xae\x42\x60\x82", 12);  // decoders do without it
    if (!file.text().ends_with(end)) return std::nullopt;
    const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(0), spng_ctx_free);
    std::size_t size = 0;
    spng_ihdr header{};
    if (spng_set_png_buffer(context.get(), file.text().data(), file.text().size()) != 0
        || spng_get_ihdr(context.get(), &header) != 0
        || spng_decoded_image_size(context.get(), SPNG_FMT_PNG, &size) != 0
        || spng_decode_image(context.get(), nullptr, 0, SPNG_FMT_PNG, SPNG_DECODE_PROGRESSIVE) != 0)
        return std::nullopt;
    std::vector<std::byte> row(size / header.height);
    int status = 0;
    while (status == 0) status = spng_decode_row(context.get(), row.data(), row.size());
    if (status != SPNG_EOI || spng_decode_chunks(context.get()) != 0) return std::nullopt;
    std::uint32_t count = 0;
    static_cast<void>(spng_get_text(context.get(), nullptr, &count));
    std::vector<spng_text> texts(count);
    if (count > 0 && spng_get_text(context.get(), texts.data(), &count) != 0) return std::nullopt;
    Metadata found;
    for (const auto& text : texts) found.emplace_back(text.keyword, std::string(text.text, text.length));
    return found;
}

const ImageFormat kPng{{".png"}, "8 or 16 bits, display-encoded, lossless", {}, openPng, readWholePng};

}  // namespace
}  // namespace limn
