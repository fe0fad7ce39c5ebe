// limn video: a film from frames that are there.

#include "job/video.h"
#include "base/log.h"
#include "cli/commands.h"

#include <fmt/format.h>

namespace limn::cli {

void addVideo(CLI::App& app, Chosen& chosen) {
    struct Options {
        std::string pattern, output;
        VideoSettings settings;
    };
    auto options = std::make_shared<Options>();
    auto* command = app.add_subcommand("video", "Make a film of frames that are there");
    command->add_option("PATTERN", options->pattern, "The frames: out/room_####.png")->required();
    command->add_option("--output", options->output, "The film: .mp4, .webm (keeps transparency) or .gif")
        ->required()
        ->type_name("FILE");
    command->add_option("--fps", options->settings.fps, "Frames per second; 24 without it")
        ->type_name("F")
        ->check(CLI::Range(0.01, 1000.0));
    command->callback([options, &chosen] {
        chosen = [options] {
            requireVideo(options->output);
            const auto frames = framesOnDisk(options->pattern);
            makeVideo(frames, options->output, options->settings);
            log::info("Saved: '{}' ({} frames, {:.2f} s)", options->output, frames.size(),
                static_cast<double>(frames.size()) / options->settings.fps);
            return ExitCode::done;
        };
    });
}

}  // namespace limn::cli
