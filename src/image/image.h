// Images in memory, and files of them.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

/// Rows from the top, channels interleaved. Floats are linear and, with alpha, premultiplied.
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;

    float* at(int x, int y) {
        return pixels.data()
            + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))
            * static_cast<std::size_t>(channels);
    }
    const float* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// One named image of a picture: an AOV. Integer AOVs carry whole numbers below 2^24 in their floats.
struct Layer {
    std::string name;
    std::vector<std::string> channels;  ///< "R", "G" ...: as EXR names them
    bool isColour = false;              ///< display-encoded in 8 and 16 bit files; half precision in EXR
    bool isInteger = false;
    Image image;
};

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// What a vector format draws over its image: lines, as drawing/ makes them. The room of images hands it on unseen.
struct VectorContent {
    virtual ~VectorContent() = default;
};

struct EncodeOptions {
    int bits = 8;            ///< 8 or 16: PNG and TIFF
    int compression = 1;     ///< zlib level of PNG: 1 fast … 9 small
    int quality = 92;        ///< JPEG
    double dpi = 0;          ///< pixels per inch, for printing; 0: not said
    double simplify = 0.02;  ///< SVG and PDF: millimetres by which a line may leave its place to have fewer points
    bool underlay = true;    ///< SVG and PDF: does the picture lie below the lines?
    std::shared_ptr<const VectorContent> vectors;  ///< of vector formats
};

/// Makes a file's bytes from a picture that comes band by band.
class ImageEncoder {
public:
    virtual ~ImageEncoder() = default;
    /// The next rows, from the top; the same layers in every band. Throws Error.
    virtual void add(std::span<const Layer> band) = 0;
    /// After the last band. Same layers, same bytes: no dates, no times, no traces of how many bands there were. The
    /// bytes have been decoded again, some rows at a time, and hold what was added; JPEG: as many rows of that size.
    virtual std::vector<std::byte> finish() = 0;
};

/// For encoders whose file decodes to something else than what went in.
Error notWhatWasWritten(std::string_view format);

/// A format of picture files. A format is one file: it ends with
///     const ImageFormat kPng{{".png"}, "what it is", {}, openPng};
/// and nothing else knows that it exists.
struct ImageFormat {
    struct Traits {
        bool isMultiLayer = false;  ///< holds all layers in one file, numbers as they are
        bool needsLibrary = false;  ///< the image library's module must be loaded for it
        bool isVector = false;      ///< draws lines from the mesh as lines, over the rest as an image
        bool isOpaque = false;      ///< holds no alpha: transparent parts come out black
    };
    /// `layers` say what will come (their images' width and channels), `height` how many rows; one layer unless
    /// multi-layer. Throws Error.
    using Open = std::unique_ptr<ImageEncoder> (*)(
        std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options);

    /// See readWholePicture().
    using ReadWhole = std::optional<Metadata> (*)(const std::filesystem::path& path);

    std::vector<std::string_view> extensions;  ///< in lower case, the usual one first
    std::string_view doc;
    Traits traits;
    Open open;
    ReadWhole readWhole;  ///< null: the image library reads it

    ImageFormat(std::vector<std::string_view> extensions_, std::string_view doc_, Traits traits_, Open open_,
        ReadWhole readWhole_ = nullptr);
    ImageFormat(const ImageFormat&) = delete;
    ImageFormat& operator=(const ImageFormat&) = delete;
};

/// The format of a file by its extension, in any case; null where there is none.
const ImageFormat* imageFormat(const std::filesystem::path& path);
/// What a path can end in, for messages: ".exr, .jpg, .png or .tif".
std::string imageExtensions();

/// The bytes of a picture that is there as a whole.
std::vector<std::byte> encodeImage(
    const ImageFormat& format, std::span<const Layer> layers, const Metadata& metadata, const EncodeOptions& options);

/// What the header of an image file says.
struct ImageInfo {
    int width = 0, height = 0, channels = 0;
    /// Grey or colours with alpha.
    bool hasAlpha() const { return channels == 2 || channels == 4; }
};
/// Throws Error, for images too large to be read as well: more than kMostPixels.
ImageInfo readImageInfo(const std::filesystem::path& path);
/// 4 GiB as floats with alpha.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

/// Reads any format the image library knows, as linear floats with unassociated alpha; throws Error.
Image readImage(const std::filesystem::path& path);

/// What a picture file says about itself, if every pixel of it can be decoded; nullopt for a missing, cut or damaged
/// one. Texts of JPEG and TIFF are in the lines "NAME: VALUE" of their description.
std::optional<Metadata> readWholePicture(const std::filesystem::path& path);

/// Loads the image library's module in the background, for those who will need it soon.
void preloadImageLibrary();

/// "in the format, encoded or quantized": 8 or 16 bit integers of a layer, display-encoded if it is a colour.
std::vector<std::uint8_t> quantize8(const Layer& layer);
std::vector<std::uint16_t> quantize16(const Layer& layer);
/// The same row by row, from the top; rows are made while those before them are taken.
void quantizeRows8(const Layer& layer, const std::function<void(const std::uint8_t*)>& take);
void quantizeRows16(const Layer& layer, const std::function<void(const std::uint16_t*)>& take);

}  // namespace limn
