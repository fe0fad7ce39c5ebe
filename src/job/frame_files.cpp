#include "job/frame_files.h"

#include "base/file.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {

FrameWriter::FrameWriter(std::filesystem::path path, const EncodeOptions& options, int height)
    : path_(std::move(path)), options_(options), height_(height) {
    if (!imageFormat(path_))
        throw Error(
            ExitCode::usage, {path_.string()}, "this is no picture file", "end the path in " + imageExtensions());
}

void FrameWriter::add(const RenderedFrame& band) {
    const ImageFormat& format = *imageFormat(path_);
    if (format.traits.isMultiLayer) {
        if (files_.empty()) files_.push_back({path_, format.open(band.layers, height_, band.metadata, options_)});
        files_.front().encoder->add(band.layers);
        return;
    }
    for (std::size_t i = 0; i < band.layers.size(); ++i) {
        const Layer& layer = band.layers[i];
        const bool isMain = layer.name == "beauty";
        // Data that 8 bits would ruin stays exact.
        const bool exact =
            !isMain && ((!layer.isColour && layer.image.channels != 1) || layer.isInteger || layer.name == "depth");
        // An opaque picture needs no alpha channel.
        Layer picture;
        if (isMain && band.opaque) {
            picture = {layer.name, {"R", "G", "B"}, layer.isColour, layer.isInteger,
                {layer.image.width, layer.image.height, 3, {}}};
            const auto count = layer.image.pixels.size() / 4;
            picture.image.pixels.resize(3 * count);
            for (std::size_t p = 0; p < count; ++p)
                std::copy_n(layer.image.pixels.data() + 4 * p, 3, picture.image.pixels.data() + 3 * p);
        }
        const std::span<const Layer> written(isMain && band.opaque ? &picture : &layer, 1);
        if (files_.size() == i) {
            std::filesystem::path to = path_;
            if (!isMain) to.replace_extension("." + layer.name + (exact ? ".exr" : path_.extension().string()));
            files_.push_back(
                {to, (exact ? *imageFormat("exact.exr") : format).open(written, height_, band.metadata, options_)});
        }
        files_[i].encoder->add(written);
    }
}

std::vector<std::filesystem::path> FrameWriter::finish() {
    std::vector<std::filesystem::path> written;
    for (auto& file : files_) {
        replaceFile(file.path, file.encoder->finish());
        written.push_back(file.path);
    }
    return written;
}

std::vector<std::filesystem::path> writeFrame(
    const RenderedFrame& frame, const std::filesystem::path& path, const EncodeOptions& options) {
    FrameWriter writer(path, options, frame.layers.front().image.height);
    writer.add(frame);
    return writer.finish();
}

}  // namespace limn
