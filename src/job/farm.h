// Scripts that draw a config's frames on many machines.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

struct FarmOptions {
    std::string config;
    std::string frames;                  ///< as --frames; empty: all declared ones
    std::vector<std::string> arguments;  ///< further ones of limn render
    int tasks = 1;
    int cpus = 0;                  ///< per task; 0: what the cluster gives
    int minutes = 0;               ///< per task; 0: what the cluster gives
    int retries = 3;               ///< times that a task that failed for the moment is queued again
    std::filesystem::path folder;  ///< for scripts and logs; empty: NAME.farm beside the working directory's files
    bool submit = false;
};

/// The scripts that were written, and how they are submitted.
struct FarmScripts {
    std::filesystem::path folder, tasks, last;
};

/// Writes a job array for Slurm, and a last job that looks at every frame and draws what is missing. Throws Error.
FarmScripts writeSlurm(const FarmOptions& options);

/// Submits them. Returns the numbers of the two jobs. Throws Error where sbatch is missing or refuses.
std::pair<std::string, std::string> submitSlurm(const FarmScripts& scripts);

/// How other programs draw frames on many machines, in words and snippets.
std::string_view farmRecipes();

}  // namespace limn
