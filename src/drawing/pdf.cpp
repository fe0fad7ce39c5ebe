// Drawings as PDF, by Cairo: one page at the sheet's scale, lines over the picture. Cairo names no layers.

#include "base/text.h"
#include "drawing/vector_encoder.h"
#include "settings/color.h"

#include <cairo-pdf.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace limn {
namespace {

constexpr double kPointsPerMillimetre = 72 / 25.4;

struct DestroySurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
    auto& all = *static_cast<std::vector<std::byte>*>(bytes);
    const auto* from = reinterpret_cast<const std::byte*>(data);
    all.insert(all.end(), from, from + length);
    return CAIRO_STATUS_SUCCESS;
}

/// Cairo gives its PNG reader's bytes out piece by piece.
struct PngBytes {
    std::vector<std::byte> bytes;
    std::size_t at = 0;
};

cairo_status_t take(void* source, unsigned char* data, unsigned length) {
    auto& png = *static_cast<PngBytes*>(source);
    if (png.bytes.size() - png.at < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, png.bytes.data() + png.at, length);
    png.at += length;
    return CAIRO_STATUS_SUCCESS;
}

class PdfEncoder : public VectorEncoder {
public:
    using VectorEncoder::VectorEncoder;
    std::vector<std::byte> finish() override {
        std::vector<std::byte> bytes;
        const double width = drawing_->millimetres(drawing_->size.x) * kPointsPerMillimetre,
                     height = drawing_->millimetres(drawing_->size.y) * kPointsPerMillimetre;
        const std::unique_ptr<cairo_surface_t, DestroySurface> surface(
            cairo_pdf_surface_create_for_stream(append, &bytes, width, height));
        // Equal input, equal bytes: the day is always the same, and the picture's own metadata tells the rest.
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "limn");
        std::string keywords;
        for (const auto& [key, value] : metadata_) keywords += fmt::format("{}={}; ", key, repairedText(value));
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_KEYWORDS, keywords.c_str());
        const std::unique_ptr<cairo_t, DestroyContext> context(cairo_create(surface.get()));
        draw(context.get());
        cairo_surface_show_page(surface.get());
        cairo_surface_finish(surface.get());
        if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS
            || cairo_status(context.get()) != CAIRO_STATUS_SUCCESS)
            throw notWhatWasWritten("PDF");
        return bytes;
    }

private:
    void draw(cairo_t* context) {
        cairo_scale(context, kPointsPerMillimetre, kPointsPerMillimetre);
        if (picture_) drawPicture(context);
        cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
        for (const auto& group : onPaper(*drawing_, options_.simplify))
            for (const auto& line : group.lines) {
                for (const auto& path : line.paths) {
                    const std::size_t count = line.isClosed ? path.size() - 1 : path.size();
                    for (std::size_t i = 0; i < count; ++i)
                        (i == 0 ? cairo_move_to : cairo_line_to)(context, path[i].x, path[i].y);
                    if (line.isClosed) cairo_close_path(context);
                }
                const auto shown = [](float linear) {
                    return std::clamp(static_cast<double>(linearToSrgb(linear)), 0.0, 1.0);
                };
                cairo_set_source_rgba(
                    context, shown(line.color.r), shown(line.color.g), shown(line.color.b), line.opacity);
                cairo_set_line_width(context, line.width);
                cairo_stroke(context);
            }
    }

    void drawPicture(cairo_t* context) {
        PngBytes png{picture_->finish()};
        const std::unique_ptr<cairo_surface_t, DestroySurface> image(
            cairo_image_surface_create_from_png_stream(take, &png));
        if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) throw notWhatWasWritten("PDF");
        const double pixel = drawing_->millimetres(1);
        cairo_save(context);
        cairo_scale(context, pixel, pixel);
        cairo_set_source_surface(context, image.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_NEAREST);
        cairo_paint(context);
        cairo_restore(context);
    }
};

std::unique_ptr<ImageEncoder> openPdf(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    EncodeOptions eight = options;  // all that Cairo takes
    eight.bits = 8;
    return std::make_unique<PdfEncoder>(layers, height, metadata, eight);
}

/// What Cairo has written is not read back: --resume draws PDFs again.
std::optional<Metadata> readWholePdf(const std::filesystem::path&) { return std::nullopt; }

const ImageFormat kPdf{{".pdf"}, "lines from the mesh as vectors to scale on one page, over the picture",
    {.isVector = true}, openPdf, readWholePdf};

}  // namespace
}  // namespace limn
