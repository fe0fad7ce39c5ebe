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

/// What was chosen for a config, and what is expected of it.
struct QualityChoice {
    Settings settings;
    double expected = 0;  ///< error or seconds
    std::string promise;  ///< "error 0.02 promised, 0.0173 expected"
};

/// Chooses settings, or takes them from `kept` (a TOML file beside the pictures) where that was made for the same
/// config and scene; writes it otherwise. All processes that draw one config find the same for an error. Throws Error
/// (usage) where no setting keeps the promise.
QualityChoice chooseQuality(
    Session& session, const RenderConfig& config, const ConfigOverrides& overrides, const std::filesystem::path& kept);

/// "walk_####.png" of walk.toml → "walk.walk.quality.toml": configs with one output do not share it.
std::filesystem::path qualityFile(const std::filesystem::path& output, const std::filesystem::path& config);

/// The config with its promise kept.
RenderConfig withQuality(Session& session, const RenderConfig& config, const ConfigOverrides& overrides,
    const std::filesystem::path& output);

}  // namespace limn
