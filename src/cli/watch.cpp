// limn watch: a picture that follows the editor.

#include "job/watch.h"
#include "cli/commands.h"
#include "study/quality.h"

namespace limn::cli {

void addWatch(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<RunOptions>();
    auto* command = app.add_subcommand("watch", "Draw a config again whenever one of its files is saved");
    command
        ->add_option_function<std::string>(
            "CONFIG", [options](const std::string& path) { options->configs = {path}; }, "Config file, or OBJ file")
        ->required();
    command->add_option("--frames", options->frames, "Frames to draw; without it the first")->type_name("SPEC");
    command->add_option("--output", options->output, "Where to: a file or a folder; without it as the config says")
        ->type_name("PATH");
    command->add_option("--set", options->overrides.settings, "Change a setting: image.samples=1, ao.radius=0.4")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_option("--camera", options->overrides.camera, "Camera of the scene to draw from")->type_name("NAME");
    addUpOption(*command, options->overrides.meshFile);
    addMemoryOption(*command);
    addDeviceFlags(*command, options->session);
    command->callback([options, &chosen] {
        chosen = [options] {
            options->keepQuality = withQuality;
            options->firstFrameOnly = options->frames.empty();
            watchJobs(*options, [] { return false; });
            return ExitCode::done;
        };
    });
}

}  // namespace limn::cli
