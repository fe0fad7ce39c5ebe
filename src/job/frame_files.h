// Frames in files.
#pragma once

#include "base/file.h"
#include "render/renderer.h"

namespace limn {

/// A file of a frame, and the layer in it; all layers where the format holds several.
struct FrameFile {
    std::filesystem::path path;
    bool isExact = false;  ///< holds data that 8 bits would ruin, as EXR
};

/// The files of a frame at `path`, in the order of its AOVs: EXR holds everything there; other formats hold the beauty
/// there, and AOVs go beside it as NAME.AOV.EXT (depth and other data as EXR). Throws Error for a path that is no
/// picture's.
std::vector<FrameFile> frameFiles(const std::filesystem::path& path, std::span<const Aov* const> aovs);

/// Is every file whole, and does it carry these entries?
bool areCurrent(std::span<const FrameFile> files, const Metadata& metadata);

/// Writes a frame band by band. Nothing is on disk before finish(), and then all of it or, if something fails, nothing.
class FrameWriter {
public:
    FrameWriter(std::vector<FrameFile> files, const EncodeOptions& options, int height);
    void add(const RenderedFrame& band, const Metadata& metadata);
    /// The files written, in order. Throws Error; what stood there before is unharmed.
    std::vector<std::filesystem::path> finish();

private:
    std::vector<FrameFile> files_;
    EncodeOptions options_;
    int height_;
    std::vector<std::unique_ptr<ImageEncoder>> encoders_;
};

}  // namespace limn
