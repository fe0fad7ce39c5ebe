#include "job/frame_files.h"

#include <algorithm>

namespace limn {

std::vector<FrameFile> frameFiles(const std::filesystem::path& path, std::span<const Aov* const> aovs) {
    const ImageFormat* format = imageFormat(path);
    if (!format)
        throw Error(
            ExitCode::usage, {path.string()}, "this is no picture file", "end the path in " + imageExtensions());
    if (format->traits.isMultiLayer) return {{path}};
    std::vector<FrameFile> files;
    for (const Aov* aov : aovs) {
        const bool isMain = aov == &aov::beauty;
        const bool isExact =
            !isMain && ((!aov->isColour() && aov->channelCount() != 1) || aov->isInteger() || aov == &aov::depth);
        std::filesystem::path to = path;
        if (!isMain)
            to.replace_extension("." + std::string(aov->name)
                + (isExact                        ? ".exr"
                        : format->traits.isVector ? ".png"
                                                  : path.extension().string()));
        files.push_back({to, isExact});
    }
    return files;
}

bool areCurrent(std::span<const FrameFile> files, const Metadata& metadata) {
    return std::all_of(files.begin(), files.end(), [&](const FrameFile& file) {
        if (!fileExists(file.path)) return false;
        const auto found = readWholePicture(file.path);
        return found && std::all_of(metadata.begin(), metadata.end(), [&](const auto& entry) {
            return std::find(found->begin(), found->end(), entry) != found->end();
        });
    });
}

FrameWriter::FrameWriter(std::vector<FrameFile> files, const EncodeOptions& options, int height)
    : files_(std::move(files)), options_(options), height_(height) {}

/// An opaque picture needs no alpha channel.
static Layer withoutAlpha(const Layer& layer) {
    Layer picture{
        layer.name, {"R", "G", "B"}, layer.isColour, layer.isInteger, {layer.image.width, layer.image.height, 3, {}}};
    const auto count = layer.image.pixels.size() / 4;
    picture.image.pixels.resize(3 * count);
    for (std::size_t p = 0; p < count; ++p)
        std::copy_n(layer.image.pixels.data() + 4 * p, 3, picture.image.pixels.data() + 3 * p);
    return picture;
}

void FrameWriter::add(const RenderedFrame& band, const Metadata& metadata) {
    const auto put = [&](std::size_t file, std::span<const Layer> layers) {
        const auto& path = files_[file].isExact ? std::filesystem::path("exact.exr") : files_[file].path;
        if (encoders_.size() == file) options_.vectors = band.drawing;
        if (encoders_.size() == file) encoders_.push_back(imageFormat(path)->open(layers, height_, metadata, options_));
        encoders_[file]->add(layers);
    };
    if (imageFormat(files_.front().path)->traits.isMultiLayer && !files_.front().isExact) return put(0, band.layers);
    for (std::size_t i = 0; i < band.layers.size(); ++i) {
        if (band.layers[i].name == "beauty" && band.opaque) {
            const Layer picture = withoutAlpha(band.layers[i]);
            put(i, {&picture, 1});
        } else {
            put(i, {&band.layers[i], 1});
        }
    }
}

std::vector<std::filesystem::path> FrameWriter::finish() {
    std::vector<PendingFile> pending;
    for (std::size_t i = 0; i < encoders_.size(); ++i) pending.emplace_back(files_[i].path, encoders_[i]->finish());
    std::vector<std::filesystem::path> written;
    for (auto& file : pending) {
        file.commit();
        written.push_back(file.path());
    }
    return written;
}

}  // namespace limn
