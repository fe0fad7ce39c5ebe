// limn render: configs to pictures.

#include "base/memory.h"
#include "base/text.h"
#include "cli/commands.h"
#include "job/run.h"
#include "study/quality.h"

#include <sched.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace limn::cli {
namespace {

/// The budget of threads: the number asked for, else the farm's grant, else the process's CPUs.
int threadBudget(int asked) {
    if (asked > 0) return asked;
    for (const char* variable : {"SLURM_CPUS_ON_NODE", "CUE_THREADS"})
        if (const char* text = std::getenv(variable))
            if (const auto value = parseNumber(text); value && *value >= 1 && *value <= 4096)
                return static_cast<int>(*value);
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

/// Draws with a budget of threads; 0 means none was asked for.
ExitCode run(RunOptions options, int asked) {
    const int threads = threadBudget(asked);
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    if (asked > 0 || std::getenv("SLURM_CPUS_ON_NODE") || std::getenv("CUE_THREADS"))
        options.session.device.threads = threads;
    options.keepQuality = withQuality;
    return runJobs(options);
}

}  // namespace

void addUpOption(CLI::App& command, MeshFileOptions& options) {
    command
        .add_option_function<std::string>(
            "--up", [&options](const std::string& axis) { options.up = axis == "z" ? Axis::z : Axis::y; },
            "Axis that points up in mesh files: y (without it) or z")
        ->type_name("AXIS")
        ->check(CLI::IsMember({"y", "z"}));
}

void addMemoryOption(CLI::App& command) {
    command
        .add_option_function<std::string>(
            "--memory-limit", [](const std::string& text) { setMemoryLimit(*parseMemory(text)); },
            "What may be taken: 8G, 512M; without it the limit of the control group or 80 % of the machine's memory")
        ->type_name("M")
        ->check([](const std::string& text) {
            return parseMemory(text) ? std::string() : "write a size, such as 8G or 512M";
        });
}

void addDeviceFlags(CLI::App& command, SessionOptions& session) {
    command
        .add_option(
            "--device", session.device.device, "EGL device: software, gpu, its number, or part of its renderer's name")
        ->type_name("D");
    command.add_flag("--require-gpu", session.device.requireGpu, "Fail (69) rather than draw in software");
    command
        .add_option("--shader-dir", session.shaderFolder, "Read shaders from this folder instead of the built-in ones")
        ->type_name("DIR");
    session.device.debug = std::getenv("LIMN_GL_DEBUG") != nullptr;
}

void addRender(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<RunOptions>();
    auto threads = std::make_shared<int>(0);
    auto* command = app.add_subcommand("render", "Draw configs (or OBJ files) into pictures");
    command->add_option("CONFIG", options->configs, "Config files, or OBJ files to draw in the quickstart's style")
        ->required();
    command
        ->add_option(
            "--frames", options->frames, "Frames: 12, 1-100, 1-100x2, 1,5,9-12; without it all that the scene declares")
        ->type_name("SPEC");
    command
        ->add_option("--output", options->output,
            "Where to: a file, a folder, or a pattern with {config} and #### for the frame")
        ->type_name("PATTERN");
    command->add_option("--set", options->overrides.settings, "Change a setting: ao.radius=0.4, edges.0.width=2px")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_option("--camera", options->overrides.camera, "Camera of the scene to draw from")->type_name("NAME");
    command
        ->add_option("--subdivide", options->overrides.meshFile.subdivide,
            "Draw OBJ files as Catmull-Clark surfaces of this level")
        ->type_name("N")
        ->check(CLI::Range(0, 10));
    addUpOption(*command, options->overrides.meshFile);
    command
        ->add_option("--chunk", options->chunk,
            "Draw the I-th of N equal parts of the frames, I from 1: for farms that count their tasks")
        ->type_name("I/N");
    command->add_flag("--resume", options->resume, "Keep frames whose files are complete and current; draw the others");
    command
        ->add_option("--frame-timeout", options->frameTimeout,
            "A frame that takes longer than this many seconds has failed (75)")
        ->type_name("S")
        ->check(CLI::PositiveNumber);
    command
        ->add_option_function<std::string>(
            "--progress",
            [options](const std::string& form) {
                options->progress = static_cast<ProgressForm>(
                    std::find(kProgressForms.begin(), kProgressForms.end(), form) - kProgressForms.begin());
            },
            "How progress is said: plain, or a farm's lines: alf (Tractor), openjd (Open Job Description)")
        ->type_name("FORM")
        ->check(CLI::IsMember(std::vector<std::string>(kProgressForms.begin(), kProgressForms.end())));
    command->add_option("--crop", options->crop, "Write only this part, in pixels from the upper left")
        ->type_name("X,Y,W,H");
    command->add_option("--threads", *threads, "CPU threads; without it what the farm or the machine grants")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    addMemoryOption(*command);
    command->add_flag("--keep-going", options->keepGoing, "Draw the other frames when one fails (exit code 1)");
    command->add_flag("--strict", options->strict, "Fail when a value in the picture is not a finite number");
    command
        ->add_option(
            "--stats", options->stats, "Write a report of the run to this JSON file: outcome and times of each frame")
        ->type_name("FILE");
    addDeviceFlags(*command, options->session);
    command->callback([options, threads, &chosen] { chosen = [options, threads] { return run(*options, *threads); }; });
}

}  // namespace limn::cli
