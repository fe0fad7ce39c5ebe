#include "job/farm.h"

#include "base/file.h"
#include "base/process.h"
#include "base/text.h"
#include "job/frames.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

/// The command that draws, but for which part of the frames.
std::string renderCommand(const FarmOptions& options) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    std::string command = shellText(program.string()) + " render "
        + shellText(std::filesystem::absolute(options.config).lexically_normal().string());
    if (!options.frames.empty()) command += " --frames " + shellText(options.frames);
    for (const auto& argument : options.arguments) command += " " + shellText(argument);
    return command + " --resume";
}

/// Directives that both jobs have.
std::string directives(const FarmOptions& options, const std::string& name, const std::string& log) {
    std::string text = fmt::format(
        "#SBATCH --job-name={}\n#SBATCH --output=\"{}\"\n#SBATCH --open-mode=append\n"
        "#SBATCH --requeue\n",
        name, log);
    if (options.cpus > 0) text += fmt::format("#SBATCH --cpus-per-task={}\n", options.cpus);
    if (options.minutes > 0)
        text += fmt::format(
            "#SBATCH --time={}\n# limn ends cleanly on this, a minute before the time is up.\n"
            "#SBATCH --signal=B:TERM@60\n",
            options.minutes);
    return text;
}

/// A word for the name of a job.
std::string jobName(const std::string& config) {
    std::string name = std::filesystem::path(config).stem().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
    return "limn-" + (name.empty() ? std::string("frames") : name);
}

void writeScript(const std::filesystem::path& path, const std::string& text) {
    replaceFile(path, text);
    std::error_code ignored;  // sbatch reads it; nobody must be able to run it
    std::filesystem::permissions(path, std::filesystem::perms::owner_exec, std::filesystem::perm_options::add, ignored);
}

}  // namespace

FarmScripts writeSlurm(const FarmOptions& options) {
    if (!options.frames.empty()) parseFrames(options.frames);
    const std::string name = jobName(options.config);
    const auto folder = std::filesystem::absolute(
        options.folder.empty() ? std::filesystem::path(name.substr(5) + ".farm") : options.folder);
    const FarmScripts scripts{folder, folder / "tasks.sh", folder / "last.sh"};
    const std::string logs = (folder / "logs").string();
    std::string logName;  // % begins a pattern there
    for (const char c : logs) logName += c == '%' ? "%%" : std::string(1, c);
    std::error_code failed;
    std::filesystem::create_directories(logs, failed);
    if (failed)
        throw Error(exitCodeForWrite(failed.value()), {logs}, fmt::format("cannot be made ({})", failed.message()),
            "choose another --folder, which all machines see");
    writeScript(scripts.tasks,
        fmt::format(R"(#!/bin/bash
# Draws one of {tasks} equal parts of the frames. Submit: sbatch {path}
{directives}#SBATCH --array=1-{tasks}

{command} --chunk "$SLURM_ARRAY_TASK_ID/{tasks}" &
limn=$!
trap 'kill -TERM $limn' TERM INT
wait $limn
code=$?
# 74: disk full or an I/O error, 75: failed for the moment, above 128: killed. What is drawn is kept: again, but not
# for ever.
if [ $code -ge 74 ] && [ $code -ne 77 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt {retries} ]; then
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID" && sleep 60
fi
exit $code
)",
            fmt::arg("tasks", options.tasks), fmt::arg("path", shellText(scripts.tasks.string())),
            fmt::arg("directives", directives(options, name, logName + "/%A_%a.log")),
            fmt::arg("command", renderCommand(options)), fmt::arg("retries", options.retries)));
    writeScript(scripts.last,
        fmt::format(R"(#!/bin/bash
# After all parts: looks at every frame, draws what is missing or damaged, and makes the film if there is to be one.
# Submit: sbatch --dependency=afterany:JOB {path}
{directives}
exec {command}
)",
            fmt::arg("path", shellText(scripts.last.string())),
            fmt::arg("directives", directives(options, name + "-last", logName + "/last.log")),
            fmt::arg("command", renderCommand(options))));
    return scripts;
}

std::pair<std::string, std::string> submitSlurm(const FarmScripts& scripts) {
    const auto submit = [](std::vector<std::string> command) {
        command.insert(command.begin(), {"sbatch", "--parsable"});
        ChildProcess sbatch(command, ChildProcess::Output::kept);
        const auto [exitCode, said] = sbatch.finish();
        const std::string number = said.substr(0, said.find_first_of(";\n"));
        if (exitCode != 0 || number.empty())
            throw Error(ExitCode::transient, {command.back()}, fmt::format("sbatch refuses it ({})", presentable(said)),
                "try again, or submit it by hand");
        return number;
    };
    const std::string tasks = submit({scripts.tasks.string()});
    return {tasks, submit({"--dependency=afterany:" + tasks, scripts.last.string()})};
}

std::string_view farmRecipes() {
    return R"(Frames on many machines: every worker runs limn render with --resume and a part of the frames. No worker
locks anything: files are complete or absent, two workers on one frame do no harm, and --resume keeps what is complete
and current. Exit codes: 0 all asked frames are on disk; 74, 75 and death by a signal are worth another try; 33 wants
more memory; 64 to 66 fail again.

GNU parallel (no daemon; untested):
  parallel --joblog log --retries 3 limn render walk.toml --resume --chunk {}/40 ::: $(seq 40)
  parallel --joblog log --resume-failed limn render walk.toml --resume --chunk {}/40 ::: $(seq 40)
  limn render walk.toml --resume                       # looks at every frame, and makes the film

Slurm (tested with a cluster of one machine):
  limn farm slurm walk.toml --tasks 40 --submit

OpenCue (untested): a layer of type Render with the frame range 1-40 and the command
  limn render walk.toml --resume --progress plain --frames #IFRAME#

Open Job Description (untested): a step whose task parameter Frames is chunked, and whose script runs
  limn render walk.toml --resume --progress openjd --frames {{Task.Param.Frames}}

Kubernetes (untested): a Job with completionMode Indexed, completions 40, backoffLimitPerIndex 3, and the command
  sh -c 'exec limn render walk.toml --resume --chunk $((JOB_COMPLETION_INDEX + 1))/40'
)";
}

}  // namespace limn
