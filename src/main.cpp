// Parses, dispatches, catches.

#include "base/heap.h"
#include "base/install.h"
#include "base/log.h"
#include "base/signals.h"
#include "cli/commands.h"

#include <fmt/format.h>

#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <new>
#include <system_error>

namespace {

using limn::ExitCode;

/// Drivers sometimes crash when a process ends. Every file is in place by now: leave without running them.
[[noreturn]] void leave(ExitCode code) {
    std::fflush(nullptr);
    _exit(static_cast<int>(code));
}

ExitCode report(const limn::Error& error) {
    limn::log::error("{}", error.message);
    return error.code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace limn;
    keepFreedMemory();
    endCleanlyOnSignals();
    // Files that grow past the limit must give an error that we report, not a signal that kills us.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);

    CLI::App app("limn: an offline renderer for toon shading, ambient occlusion and line drawings.", "limn");
    app.set_version_flag("--version", fmt::format("limn {}", kVersion));
    app.require_subcommand(1);
    app.footer("Every parameter: limn techniques. A first picture: limn render MODEL.obj");
    bool verbose = false, quiet = false;
    app.add_flag("--verbose", verbose, "Say more");
    app.add_flag("--quiet", quiet, "Say only what is wrong");
    app.fallthrough();
    cli::Chosen chosen;
    cli::addRender(app, chosen);
    cli::addWatch(app, chosen);
    cli::addPlan(app, chosen);
    cli::addCheck(app, chosen);
    cli::addTechniques(app, chosen);
    cli::addInit(app, chosen);
    cli::addMesh(app, chosen);
    cli::addVideo(app, chosen);
    cli::addFarm(app, chosen);
    cli::addStudy(app, chosen);
    cli::addDoctor(app, chosen);
    try {
        app.parse(argc, argv);
        log::configure(quiet ? log::Level::warning : verbose ? log::Level::debug : log::Level::info);
        leave(chosen());
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        leave(code == 0 ? ExitCode::done : ExitCode::usage);
    } catch (const Error& error) { leave(report(error)); } catch (const Errors& errors) {
        for (const auto& error : errors.list) report(error);
        leave(errors.code());
    } catch (const std::bad_alloc&) {
        log::error("out of memory; make the picture smaller or use fewer samples");
        leave(ExitCode::outOfMemory);
    } catch (const std::system_error& error) {
        // Who reads our output may stop early, as `head` does: that is no failure.
        if (error.code() == std::errc::broken_pipe) leave(ExitCode::done);
        log::error("{}; please report this", error.what());
        leave(ExitCode::internal);
    } catch (const std::exception& error) {
        log::error("{}; please report this", error.what());
        leave(ExitCode::internal);
    }
}
