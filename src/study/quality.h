// Settings that keep a promise: quality = { error = 0.02 } or { seconds = 1.5 } in a config.
//
// error: root mean square of ambient occlusion beside rays, over the pixels that show a surface, with the samples that
// the config has. Candidates are tried in the order of a fixed model of cost in windows of the picture itself, spread
// over it, so that machines agree. seconds: of drawing a frame on this machine.
#pragma once

#include "job/session.h"
#include "study/knobs.h"

#include <filesystem>

namespace limn {

/// The config with settings that keep its promise. They are chosen, or taken from a TOML file beside `output` where
/// that was made for the same config and scene; it is written otherwise. All processes that draw one config find the
/// same for an error. Throws Error (usage) where no setting keeps the promise.
RenderConfig withQuality(Session& session, const RenderConfig& config, const ConfigOverrides& overrides,
    const std::filesystem::path& output);

}  // namespace limn
