// Frames in files.
#pragma once

#include "render/renderer.h"

namespace limn {

/// Writes a frame band by band. Nothing is on disk before finish().
class FrameWriter {
public:
    FrameWriter(std::filesystem::path path, const EncodeOptions& options, int height);
    void add(const RenderedFrame& band);
    std::vector<std::filesystem::path> finish();

private:
    struct File {
        std::filesystem::path path;
        std::unique_ptr<ImageEncoder> encoder;
    };
    std::filesystem::path path_;
    EncodeOptions options_;
    int height_;
    std::vector<File> files_;
};

/// Writes a frame: EXR holds everything at `path`; other formats hold the beauty there, and AOVs go beside it as
/// NAME.AOV.EXT (depth and other data as EXR). Returns the files written, in order.
std::vector<std::filesystem::path> writeFrame(
    const RenderedFrame& frame, const std::filesystem::path& path, const EncodeOptions& options);

}  // namespace limn
