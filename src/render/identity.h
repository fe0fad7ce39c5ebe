// What a frame's picture follows from: equal identities, equal bits.
#pragma once

#include "gl/device.h"
#include "image/image.h"
#include "render/pipeline.h"

namespace limn {

/// What every file of a picture carries. Two files with the same entries hold the same pixels.
Metadata metadataOf(const RenderConfig& config, const SceneAt& scene, int frame, const PixelRect& crop,
    const gl::DeviceReport& device, const std::string& shaders, const Pipeline& pipeline);

/// Covers everything that the pixels follow from but device and crop: frames with the same key show the same.
ContentKey pixelsKey(const RenderConfig& config, const SceneAt& scene, int frame);

/// The content key of a folder's shaders as text; empty for the ones built in.
std::string shadersKey(const std::filesystem::path& folder);

}  // namespace limn
