// limn doctor: the machine's abilities, and why something does not work.

#include "base/install.h"
#include "cli/commands.h"
#include "image/codecs.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

namespace limn::cli {
namespace {

ExitCode run(const SessionOptions& options) {
    fmt::print("limn {}\n\nEGL devices\n", kVersion);
    for (const auto& report : gl::probeDevices()) {
        fmt::print("  {}  {:<14} {}\n", report.index, report.name,
            report.works ? fmt::format(
                "works: {} ({}), OpenGL {}", report.renderer, report.isSoftware ? "software" : "GPU", report.version)
                         : "does not work: " + report.problem);
    }
    for (const char* variable : {"__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS", "LIBGL_ALWAYS_SOFTWARE",
             "GALLIUM_DRIVER", "LP_NUM_THREADS", "MESA_SHADER_CACHE_DISABLE", "CUDA_VISIBLE_DEVICES"})
        if (const char* value = std::getenv(variable)) fmt::print("  {} = {}\n", variable, value);
    const gl::Device device(options.device);
    const auto& limits = device.limits();
    fmt::print("\nchosen: {}, OpenGL {}\n", device.report().renderer, device.report().version);
    if (device.report().isSoftware)
        fmt::print(
            "  This is a software renderer: right, but slow beside a GPU. If this machine has one, its driver's EGL "
            "files are missing.\n");
    fmt::print("  largest texture {}, largest viewport {}, {} million elements per buffer texture\n",
        limits.maxTextureSize, limits.maxViewport, limits.maxBufferTexels / 1000000);
    fmt::print("\nCPU threads: {}\n", std::thread::hardware_concurrency());
    try {
        static_cast<void>(imageModule());
        fmt::print("image module: works ({})\n", (moduleFolder() / "limn-oiio.so").string());
    } catch (const Error& error) { fmt::print("image module: {}\n", error.message); }
    return ExitCode::done;
}

}  // namespace

void addDoctor(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<SessionOptions>();
    auto* command = app.add_subcommand(
        "doctor", "Show which devices and drivers were tried, which works and why the others do not");
    addDeviceFlags(*command, *options);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace limn::cli
