// The commands. Each adds itself to the command line, runs when chosen, and returns the exit code.
#pragma once

#include "job/session.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace limn::cli {

/// The command that was chosen, to be run after parsing.
using Chosen = std::function<ExitCode()>;

void addRender(CLI::App& app, Chosen& chosen);
void addWatch(CLI::App& app, Chosen& chosen);
void addPlan(CLI::App& app, Chosen& chosen);
void addCheck(CLI::App& app, Chosen& chosen);
void addTechniques(CLI::App& app, Chosen& chosen);
void addInit(CLI::App& app, Chosen& chosen);
void addMesh(CLI::App& app, Chosen& chosen);
void addFarm(CLI::App& app, Chosen& chosen);
void addVideo(CLI::App& app, Chosen& chosen);
void addStudy(CLI::App& app, Chosen& chosen);
void addDoctor(CLI::App& app, Chosen& chosen);

/// Options of the device that several commands share.
void addDeviceFlags(CLI::App& command, SessionOptions& session);
void addMemoryOption(CLI::App& command);
void addUpOption(CLI::App& command, MeshFileOptions& options);

/// The parameter reference, as Markdown.
std::string parameterReference();

}  // namespace limn::cli
