// limn render: configs to pictures.

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "render/frame_files.h"

#include <fmt/format.h>
#include <sched.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <optional>

namespace limn::cli {
namespace {

struct Options {
    std::vector<std::string> configs;
    ConfigOverrides overrides;
    std::string output, frames, crop, stats;
    int threads = 0;
    bool strict = false, keepGoing = false;
    DeviceFlags device;
};

PixelRect parseCrop(const std::string& text, glm::ivec2 size) {
    PixelRect rect;
    int* numbers[] = {&rect.origin.x, &rect.origin.y, &rect.size.x, &rect.size.y};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int i = 0; i < 4; ++i) {
        const auto [next, status] = std::from_chars(at, end, *numbers[i]);
        const bool comma = next < end && *next == ',';
        if (status != std::errc() || (i < 3 ? !comma : next != end))
            throw Error(ExitCode::usage, {fmt::format("--crop {}", text)}, "this is not X,Y,W,H",
                "write for example --crop 100,50,320,200, in pixels from the upper left");
        at = next + 1;
    }
    if (rect.origin.x < 0 || rect.origin.y < 0 || rect.size.x < 1 || rect.size.y < 1
        || rect.size.x > size.x - rect.origin.x || rect.size.y > size.y - rect.origin.y)
        throw Error(ExitCode::usage, {fmt::format("--crop {}", text)},
            fmt::format("the rectangle does not lie in the picture of {}×{}", size.x, size.y), "");
    return rect;
}

/// "12", "1-100", "1-100x2", "1,5,9-12", "10-1", "-5--1".
std::vector<int> parseFrames(const std::string& text) {
    const auto fail = [&]() -> int {
        throw Error(ExitCode::usage, {fmt::format("--frames {}", text)}, "this is no list of frames",
            "write for example 12, 1-100, 1-100x2 or 1,5,9-12");
    };
    std::vector<int> frames;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto number = [&] {
        int value = 0;
        const auto [next, status] = std::from_chars(at, end, value);
        if (status != std::errc() || std::abs(static_cast<long>(value)) > 100'000'000) fail();
        at = next;
        return value;
    };
    while (true) {
        const int first = number();
        int last = first, step = 1;
        if (at < end && *at == '-') {
            ++at;
            last = number();
            if (at < end && *at == 'x') {
                ++at;
                step = number();
            }
        }
        if (step < 1 || std::abs(static_cast<long>(last) - first) / step > 10'000'000) fail();
        for (int f = first; first <= last ? f <= last : f >= last; f += first <= last ? step : -step)
            frames.push_back(f);
        if (at == end) return frames;
        if (*at++ != ',') fail();
    }
}

/// A budget of threads: what was asked for, else what a farm granted, else what the process may use.
int threadBudget(int asked) {
    if (asked > 0) return asked;
    for (const char* variable : {"SLURM_CPUS_ON_NODE", "CUE_THREADS"})
        if (const char* text = std::getenv(variable))
            if (const auto value = parseNumber(text); value && *value >= 1 && *value <= 4096)
                return static_cast<int>(*value);
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

std::filesystem::path outputPath(const RenderConfig& config, const std::string& asked, bool several) {
    if (asked.empty()) return config.output.path;
    std::string text = asked;
    const std::string stem = config.file.stem().string();
    if (const auto at = text.find("{config}"); at != std::string::npos) {
        text.replace(at, 8, stem);
        several = false;
    }
    std::error_code unknown;
    if (std::filesystem::is_directory(text, unknown) || text.ends_with('/'))
        return std::filesystem::path(text) / config.output.path.filename();
    if (several)
        throw Error(ExitCode::usage, {fmt::format("--output {}", asked)}, "several configs would write the same file",
            "put {config} into the path, or name a folder");
    if (!fileFormat(text))
        throw Error(ExitCode::usage, {fmt::format("--output {}", asked)}, "this is no picture file",
            "end the path in .png, .jpg, .tif or .exr");
    return text;
}

/// A config with everything that is known about it before drawing.
struct Job {
    RenderConfig config;
    std::filesystem::path output;
    std::vector<int> frames;
    LoadedScene loaded;
    std::future<void> loading;
};

void appendStats(std::string& stats, const std::filesystem::path& file, int frame, const RenderedFrame& rendered,
    double writeMs, double totalMs) {
    if (!stats.empty()) stats += ",\n";
    stats += fmt::format("  {{\"file\": {}, \"frame\": {}, \"parts\": {{", jsonText(file.string()), frame);
    for (const auto& part : rendered.times) stats += fmt::format("\"{}\": {:.2f}, ", part.name, part.milliseconds);
    stats += fmt::format("\"write\": {:.2f}}}, \"total\": {:.2f}}}", writeMs, totalMs);
}

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::vector<int> framesOf(
    const RenderConfig& config, const std::string& asked, const std::optional<FrameRange>& declared) {
    if (!asked.empty()) return parseFrames(asked);
    if (!declared && !config.frames) return {1};
    const FrameRange range = config.frames ? *config.frames : *declared;
    std::vector<int> frames;
    for (int f = range.first; f <= range.last; ++f) frames.push_back(f);
    return frames;
}

ExitCode run(const Options& options) {
    const auto start = Clock::now();
    const int threads = threadBudget(options.threads);
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    gl::DeviceOptions deviceOptions = options.device.options;
    if (options.threads > 0 || std::getenv("SLURM_CPUS_ON_NODE") || std::getenv("CUE_THREADS"))
        deviceOptions.threads = threads;

    // Everything that the configs alone can tell comes out before anything is drawn.
    ErrorCollector errors;
    std::vector<Job> jobs;
    for (const auto& path : options.configs) {
        try {
            Job job{readRenderConfig(path, options.overrides), {}, {}, {}, {}};
            job.output = outputPath(job.config, options.output, options.configs.size() > 1);
            for (const auto& other : jobs)
                if (other.output.lexically_normal() == job.output.lexically_normal())
                    throw Error(ExitCode::usage, {path},
                        fmt::format(
                            "would write the same file as '{}': '{}'", other.config.file.string(), job.output.string()),
                        "put {config} into --output, or give each its own output.path");
            if (!options.crop.empty()) static_cast<void>(parseCrop(options.crop, job.config.image.size));
            jobs.push_back(std::move(job));
        } catch (const Error& error) { errors.add(error); } catch (const Errors& several) {
            for (const auto& error : several.list) errors.add(error);
        }
    }
    errors.throwIfAny();
    bool needsModule = false;
    for (const auto& job : jobs) {
        const auto format = fileFormat(job.output);
        needsModule = needsModule || format == FileFormat::jpeg || format == FileFormat::tiff;
    }
    if (needsModule) preloadImageLibrary();
    // The next scene loads while the one before is drawn. The first one loads while the device starts, and is
    // tessellated as far as it gets.
    const auto startLoading = [&](std::size_t i) {
        if (i < jobs.size())
            jobs[i].loading = std::async(std::launch::async, [&job = jobs[i]] { job.loaded = loadScene(job.config); });
    };
    std::promise<void> firstLoaded;
    jobs.front().loading = firstLoaded.get_future();
    auto firstMeshes = std::async(std::launch::async, [&job = jobs.front(), &firstLoaded, &options] {
        try {
            job.loaded = loadScene(job.config);
        } catch (...) {
            firstLoaded.set_exception(std::current_exception());
            return SceneMeshes();
        }
        firstLoaded.set_value();
        const auto& meshes = job.loaded.scene.meshes;
        const bool perFrame = std::any_of(meshes.begin(), meshes.end(), [](const auto& mesh) { return mesh.perFrame; });
        return perFrame ? SceneMeshes()
                        : buildMeshes(job.config, job.loaded,
                            framesOf(job.config, options.frames, job.loaded.scene.frames).front());
    });
    Renderer renderer(deviceOptions, options.device.shaderFolder);
    const auto& device = renderer.device().report();
    log::debug("drawing on {} ({})", device.renderer, device.version);
    renderer.await(std::move(firstMeshes));
    const double deviceMs = since(start);

    std::string stats;
    std::size_t failed = 0, done = 0;
    ExitCode firstFailure = ExitCode::done;
    const auto failFrame = [&](const Error& error) {
        if (!options.keepGoing) throw error;
        log::error("{}", error.message);
        if (failed++ == 0) firstFailure = error.code;
    };
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        Job& job = jobs[j];
        LoadedScene& loaded = job.loaded;
        try {
            job.loading.get();
        } catch (...) {
            startLoading(j + 1);
            if (!options.keepGoing) throw;
            try {
                throw;
            } catch (const Errors& several) {
                for (const auto& error : several.list) failFrame(error);
            } catch (const Error& error) { failFrame(error); }
            continue;
        }
        startLoading(j + 1);
        const double loadMs = since(start);
        job.frames = framesOf(job.config, options.frames, loaded.scene.frames);
        if (job.frames.size() > 1 && !hasFrameNumber(job.output))
            throw Error(ExitCode::usage, {job.output.string()},
                fmt::format("{} frames would be written to one file", job.frames.size()),
                "put #### into the path: room_####.png");
        for (const int frame : job.frames) {
            const auto frameStart = Clock::now();
            const auto path = framePath(job.output, frame);
            try {
                RenderOptions renderOptions;
                if (!options.crop.empty()) renderOptions.crop = parseCrop(options.crop, job.config.image.size);
                // What memory should not hold twice is encoded while it is drawn.
                const glm::ivec2 size = renderOptions.crop.size.x > 0 ? renderOptions.crop.size : job.config.image.size;
                FrameWriter writer(path, job.config.output.encode, size.y);
                renderOptions.onBand = [&](const RenderedFrame& band) { writer.add(band); };
                goToFrame(loaded, frame);
                RenderedFrame rendered = renderer.render(job.config, loaded, frame, renderOptions);
                if (done == 0)
                    rendered.times.insert(rendered.times.begin(),
                        {{"device", deviceMs}, {"load, beyond the device", std::max(0.0, loadMs - deviceMs)}});
                if (rendered.nonFinite > 0) {
                    const auto text =
                        fmt::format("{} values in {} are not finite numbers", rendered.nonFinite, path.string());
                    if (options.strict) throw Error(ExitCode::internal, {}, text, "please report this, with the scene");
                    log::warning("{}: please report this, with the scene", text);
                }
                const auto writeStart = Clock::now();
                const auto files = writer.finish();
                const double writeMs = since(writeStart), totalMs = done == 0 ? since(start) : since(frameStart);
                for (const auto& file : files) log::info("Saved: '{}' ({:.1f} ms)", file.string(), totalMs);
                for (const auto& part : rendered.times) log::debug("  {:<24} {:8.1f} ms", part.name, part.milliseconds);
                log::debug("  {:<24} {:8.1f} ms", "write", writeMs);
                appendStats(stats, path, frame, rendered, writeMs, totalMs);
                ++done;
            } catch (const Error& error) { failFrame(error); } catch (const Errors& several) {
                if (!options.keepGoing) throw;
                for (const auto& error : several.list) failFrame(error);
            }
        }
        renderer.await({});  // what nobody came for
        loaded = {};
    }
    if (!renderer.device().debugMessages().empty())
        throw Error(ExitCode::internal, {},
            fmt::format("the GL driver objects: {}", renderer.device().debugMessages().front()), "please report this");
    if (!options.stats.empty()) replaceFile(options.stats, fmt::format("[\n{}\n]\n", stats));
    if (failed == 0) return ExitCode::done;
    return done > 0 ? ExitCode::someFramesFailed : firstFailure;
}

}  // namespace

void DeviceFlags::add(CLI::App& command) {
    command
        .add_option("--device", options.device, "EGL device: software, gpu, its number, or part of its renderer's name")
        ->type_name("D");
    command.add_flag("--require-gpu", options.requireGpu, "Fail (69) rather than draw in software");
    command.add_option("--shader-dir", shaderFolder, "Read shaders from this folder instead of the built-in ones")
        ->type_name("DIR");
    options.debug = std::getenv("LIMN_GL_DEBUG") != nullptr;
}

void addRender(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<Options>();
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
        ->add_option(
            "--subdivide", options->overrides.subdivide, "Draw OBJ files as Catmull-Clark surfaces of this level")
        ->type_name("N")
        ->check(CLI::Range(0, 10));
    command->add_option("--crop", options->crop, "Write only this part, in pixels from the upper left")
        ->type_name("X,Y,W,H");
    command->add_option("--threads", options->threads, "CPU threads; without it what the farm or the machine grants")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--keep-going", options->keepGoing, "Draw the other frames when one fails (exit code 1)");
    command->add_flag("--strict", options->strict, "Fail when a value in the picture is not a finite number");
    command->add_option("--stats", options->stats, "Write the times of each part to this JSON file")->type_name("FILE");
    options->device.add(*command);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace limn::cli
