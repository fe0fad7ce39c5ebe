// limn farm: frames on many machines.

#include "job/farm.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "study/quality.h"

#include <fmt/format.h>

namespace limn::cli {
namespace {

ExitCode runSlurm(const FarmOptions& options) {
    // What cannot be drawn is said here, not by forty machines.
    ConfigOverrides overrides;
    for (std::size_t i = 0; i + 1 < options.arguments.size(); ++i)
        if (options.arguments[i] == "--set") overrides.settings.push_back(options.arguments[++i]);
    const RenderConfig config = readRenderConfig(options.config, overrides);
    if (config.quality.isAsked()) {  // chosen once, for all machines
        Session session;
        withQuality(session, config, overrides, config.output.path);
    }
    const FarmScripts scripts = writeSlurm(options);
    for (const auto& file : {scripts.tasks, scripts.last}) log::info("Saved: '{}'", file.string());
    if (!options.submit) {
        log::info("submit it with:  job=$(sbatch --parsable {}) && sbatch --dependency=afterany:$job {}",
            shellText(scripts.tasks.string()), shellText(scripts.last.string()));
        return ExitCode::done;
    }
    const auto [tasks, last] = submitSlurm(scripts);
    log::info("submitted: job {} with {} tasks, and job {} after it", tasks, options.tasks, last);
    return ExitCode::done;
}

}  // namespace

void addFarm(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<FarmOptions>();
    auto* command = app.add_subcommand("farm", "Draw frames on many machines");
    command->require_subcommand(1);
    auto* slurm = command->add_subcommand("slurm", "Write a job array for Slurm, or submit it");
    slurm->add_option("CONFIG", options->config, "Config file")->required();
    slurm->add_option("--frames", options->frames, "Frames; without it all that the scene declares")->type_name("SPEC");
    slurm->add_option("--tasks", options->tasks, "Into how many parts the frames are cut")
        ->required()
        ->type_name("N")
        ->check(CLI::Range(1, 100'000));
    slurm
        ->add_option(
            "--set",
            [options](const CLI::results_t& settings) {
                for (const auto& setting : settings)
                    options->arguments.insert(options->arguments.end(), {"--set", setting});
                return true;
            },
            "Change a setting: ao.radius=0.4")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    slurm->add_option("--cpus", options->cpus, "CPUs per task")->type_name("N")->check(CLI::Range(1, 4096));
    slurm->add_option("--time", options->minutes, "Minutes per task")->type_name("M")->check(CLI::Range(2, 100'000));
    slurm->add_option("--retries", options->retries, "How often a task that failed for the moment is tried again")
        ->type_name("N")
        ->check(CLI::Range(0, 100));
    slurm
        ->add_option(
            "--folder", options->folder, "For scripts and logs; all machines must see it. NAME.farm without it")
        ->type_name("DIR");
    slurm->add_flag("--submit", options->submit, "Submit it by sbatch");
    slurm->callback([options, &chosen] { chosen = [options] { return runSlurm(*options); }; });
    auto* recipes =
        command->add_subcommand("recipes", "How other programs do it: GNU parallel, OpenCue, Kubernetes ...");
    recipes->callback([&chosen] {
        chosen = [] {
            fmt::print("{}", farmRecipes());
            return ExitCode::done;
        };
    });
}

}  // namespace limn::cli
