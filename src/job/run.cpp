#include "job/run.h"

#include "base/file.h"
#include "base/log.h"
#include "job/frame_files.h"
#include "job/frames.h"
#include "job/progress.h"
#include "job/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

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
    if (!imageFormat(text))
        throw Error(ExitCode::usage, {fmt::format("--output {}", asked)}, "this is no picture file",
            "end the path in " + imageExtensions());
    return text;
}

/// A config and all that is known about it before drawing.
struct Job {
    RenderConfig config;
    std::filesystem::path output;
    PixelRect crop;  ///< empty: everything
};

Job readJob(const std::string& path, const RunOptions& options, const std::vector<Job>& before) {
    Job job{readRenderConfig(path, options.overrides), {}, {}};
    job.output = outputPath(job.config, options.output, options.configs.size() > 1);
    for (const auto& other : before)
        if (other.output.lexically_normal() == job.output.lexically_normal())
            throw Error(ExitCode::usage, {path},
                fmt::format("would write the same file as '{}': '{}'", other.config.file.string(), job.output.string()),
                "put {config} into --output, or give each its own output.path");
    if (job.config.image.transparent && imageFormat(job.output)->traits.isOpaque)
        log::warning(
            "{}: '{}' cannot be transparent: its background comes out black; end the path in .png, .tif or .exr", path,
            job.output.string());
    if (!options.crop.empty()) job.crop = parseCrop(options.crop, job.config.image.size);
    return job;
}

/// Reads all configs, and reports every problem in them before anything is drawn.
std::vector<Job> readJobs(const RunOptions& options) {
    ErrorCollector errors;
    std::vector<Job> jobs;
    for (const auto& path : options.configs) errors.run([&] { jobs.push_back(readJob(path, options, jobs)); });
    errors.throwIfAny();
    const bool needsLibrary = std::any_of(jobs.begin(), jobs.end(), [](const Job& job) {
        const ImageFormat* format = imageFormat(job.output);
        return format && format->traits.needsLibrary;
    });
    if (needsLibrary) preloadImageLibrary();
    return jobs;
}

class Run {
public:
    explicit Run(const RunOptions& options) : options_(options), session_(options.session) {}

    ExitCode draw() {
        const std::vector<Job> jobs = readJobs(options_);
        // What cannot be written is said before anything is drawn for it.
        if (!options_.stats.empty()) requireWritable(options_.stats);
        // The first scene loads while the device starts, and its meshes are made as far as time allows.
        std::optional<int> first;
        if (!options_.frames.empty()) first = parseFrames(options_.frames).front();
        session_.makeAhead(jobs.front().config, first);
        const auto& device = session_.renderer().device();
        log::debug("drawing on {} ({})", device.report().renderer, device.report().version);
        deviceMilliseconds_ = since(start_);
        for (std::size_t j = 0; j < jobs.size(); ++j) {
            // The next scene loads while this one is drawn.
            const auto ahead = [&] {
                if (j + 1 < jobs.size()) session_.loadAhead(jobs[j + 1].config);
            };
            attempt([&] {
                progress_.begin(fmt::format("reading {}", jobs[j].config.scene.string()));
                const LoadedScene& loaded = session_.load(jobs[j].config);
                progress_.end();
                ahead();
                drawJob(jobs[j], loaded);
            });
            ahead();
            const bool isDone = std::none_of(jobs.begin() + static_cast<std::ptrdiff_t>(j) + 1, jobs.end(),
                [&](const Job& later) { return later.config.scene == jobs[j].config.scene; });
            if (isDone) session_.forget(jobs[j].config);
        }
        if (!device.debugMessages().empty())
            throw Error(ExitCode::internal, {},
                fmt::format("the GL driver objects: {}", device.debugMessages().front()), "please report this");
        if (!options_.stats.empty()) replaceFile(options_.stats, statistics_.json());
        if (failed_ == 0) return ExitCode::done;
        return done_ > 0 ? ExitCode::someFramesFailed : firstFailure_;
    }

private:
    /// Runs `work`; with --keep-going it reports and counts what that throws.
    void attempt(const auto& work) {
        if (!options_.keepGoing) return work();
        std::vector<Error> errors;
        collect(errors, work);
        for (const auto& error : errors) {
            log::error("{}", error.message);
            if (failed_++ == 0) firstFailure_ = error.code;
        }
    }

    void drawJob(const Job& job, const LoadedScene& loaded) {
        if (done_ == 0) loadMilliseconds_ = since(start_);
        const std::vector<int> frames = framesOf(job.config, options_.frames, loaded.scene.frames);
        if (frames.size() > 1 && !hasFrameNumber(job.output))
            throw Error(ExitCode::usage, {job.output.string()},
                fmt::format("{} frames would be written to one file", frames.size()),
                "put #### into the path: room_####.png");
        tellBeyond(job, loaded, frames);
        for (const int frame : frames) attempt([&] { drawFrame(job, frame); });
    }

    /// Frames that no scene declares are drawn, with what the nearest declared one shows; asking for them may be a
    /// slip.
    void tellBeyond(const Job& job, const LoadedScene& loaded, const std::vector<int>& frames) const {
        const auto& declared = loaded.scene.frames;
        if (!declared) return;
        const auto beyond = std::count_if(
            frames.begin(), frames.end(), [&](int frame) { return frame < declared->first || frame > declared->last; });
        if (beyond > 0)
            log::warning("{}: {} of {} frames lie beyond {}-{}, which the scene declares", job.config.scene.string(),
                beyond, frames.size(), declared->first, declared->last);
    }

    void drawFrame(const Job& job, int frame) {
        const auto frameStart = done_ == 0 ? start_ : Clock::now();
        const auto path = framePath(job.output, frame);
        // Encodes while drawing, so that memory does not hold the picture twice.
        FrameWriter writer(
            path, job.config.output.encode, job.crop.size.x > 0 ? job.crop.size.y : job.config.image.size.y);
        RenderOptions wanted;
        wanted.crop = job.crop;
        wanted.onBand = [&](const RenderedFrame& band) { writer.add(band); };
        wanted.onProgress = [&](double share) { progress_.reach(share); };
        progress_.begin(path.string());
        RenderedFrame rendered = session_.draw(job.config, frame, wanted);
        if (rendered.nonFinite > 0) tellNonFinite(rendered.nonFinite, path);
        std::vector<PartTime> parts = std::move(rendered.times);
        if (done_ == 0)
            parts.insert(parts.begin(),
                {{"device", deviceMilliseconds_},
                    {"load, beyond the device", std::max(0.0, loadMilliseconds_ - deviceMilliseconds_)}});
        const auto writeStart = Clock::now();
        const auto files = writer.finish();
        parts.push_back({"write", since(writeStart)});
        const double total = since(frameStart);
        progress_.end();
        for (const auto& file : files) log::info("Saved: '{}' ({:.1f} ms)", file.string(), total);
        for (const auto& part : parts) log::debug("  {:<24} {:8.1f} ms", part.name, part.milliseconds);
        statistics_.addFrame(path, frame, parts, total);
        ++done_;
    }

    void tellNonFinite(std::uint64_t count, const std::filesystem::path& path) const {
        const auto text = fmt::format("{} values in {} are not finite numbers", count, path.string());
        if (options_.strict) throw Error(ExitCode::internal, {}, text, "please report this, with the scene");
        log::warning("{}: please report this, with the scene", text);
    }

    const RunOptions& options_;
    Clock::time_point start_ = Clock::now();
    Session session_;
    Statistics statistics_;
    Progress progress_;
    double deviceMilliseconds_ = 0, loadMilliseconds_ = 0;  ///< since the run began
    std::size_t failed_ = 0, done_ = 0;
    ExitCode firstFailure_ = ExitCode::done;
};

}  // namespace

ExitCode runJobs(const RunOptions& options) { return Run(options).draw(); }

}  // namespace limn
