#include "job/run.h"

#include "base/file.h"
#include "base/log.h"
#include "job/behind.h"
#include "job/frame_files.h"
#include "job/frames.h"
#include "job/statistics.h"
#include "job/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A frame on its way to its files.
struct FrameTask {
    FrameWriter writer;
    Statistics::Frame report;
    Clock::time_point begun;
    bool isBroken = false;     ///< an earlier step failed
    bool hasFlicker = false;   ///< its change from the frame before is measured
    bool followsLast = false;  ///< the frame before it in time was drawn before it
};
using SharedTask = std::shared_ptr<FrameTask>;

/// The pixels of the last frame, for those after it that show the same.
struct LastFrame {
    ContentKey pixels;
    std::vector<std::shared_ptr<const RenderedFrame>> bands;  ///< empty: not kept
};

/// A picture of more bytes is not kept for the next frame.
constexpr std::size_t kMostKept = std::size_t{256} << 20;

class Run {
public:
    Run(const RunOptions& options, Session& session, bool keepsScenes)
        : options_(options),
          session_(session),
          keepsScenes_(keepsScenes),
          progress_(options.progress, std::chrono::duration<double>(options.frameTimeout)) {}

    ExitCode draw() {
        std::vector<Job> jobs = readJobs(options_);
        // What cannot be written is said before anything is drawn for it.
        if (!options_.stats.empty()) requireWritable(options_.stats);
        Errors failures;
        collect(failures.list, [&] { drawAll(jobs); });
        // What was drawn before a failure is still written.
        if (!failures.list.empty()) {
            collect(failures.list, [&] { behind_.wait(); });
            statistics_.add(
                {current_.first, current_.second, FrameOutcome::failed, {}, 0, failures.list.front().message, {}});
        }
        ExitCode code = failures.list.empty() ? ExitCode::done : failures.code();
        if (failures.list.empty() && failed_ > 0) code = succeeded_ > 0 ? ExitCode::someFramesFailed : firstFailure_;
        if (!options_.stats.empty())
            replaceFile(options_.stats, statistics_.json(deviceName_, code, since(start_) / 1000));
        if (!failures.list.empty()) throw std::move(failures);
        return code;
    }

private:
    void drawAll(std::vector<Job>& jobs) {
        // The first scene loads while the device starts, and its meshes are made as far as time allows.
        std::optional<int> first;
        if (!options_.frames.empty()) first = parseFrames(options_.frames).front();
        if (!options_.resume && options_.chunk.empty()) session_.makeAhead(jobs.front().config, first);
        const gl::DeviceReport device = session_.renderer().device().report();
        deviceName_ = device.renderer;
        log::debug("drawing on {} ({})", device.renderer, device.version);
        deviceMilliseconds_ = since(start_);
        for (std::size_t j = 0; j < jobs.size(); ++j) {
            // The next scene loads while this one is drawn.
            const auto ahead = [&] {
                if (j + 1 < jobs.size()) session_.loadAhead(jobs[j + 1].config);
            };
            attempt(jobs[j].output, 0, [&] {
                progress_.begin(fmt::format("reading {}", jobs[j].config.scene.string()));
                const LoadedScene& loaded = session_.load(jobs[j].config);
                progress_.end();
                keepQuality(jobs[j]);
                ahead();
                loadMilliseconds_ = loadMilliseconds_ > 0 ? loadMilliseconds_ : since(start_);
                const std::vector<int> frames = framesOf(jobs[j], options_, loaded);
                progress_.beginJob(j, jobs.size(), frames.size());
                const std::size_t failedBefore = failures();
                drawFrames(jobs[j], frames);
                film(jobs[j], frames, loaded.scene.fps, failedBefore);
            });
            ahead();
            const bool isDone = std::none_of(jobs.begin() + static_cast<std::ptrdiff_t>(j) + 1, jobs.end(),
                [&](const Job& later) { return later.config.scene == jobs[j].config.scene; });
            if (isDone && !keepsScenes_) session_.forget(jobs[j].config);
        }
        behind_.wait();
        const auto& messages = session_.renderer().device().debugMessages();
        if (!messages.empty())
            throw Error(ExitCode::internal, {}, fmt::format("the GL driver objects: {}", messages.front()),
                "please report this");
    }

    /// Chooses settings where the config asks for a quality. Nothing else may run meanwhile: it takes times.
    void keepQuality(Job& job) {
        if (!job.config.quality.isAsked() || !options_.keepQuality) return;
        requireWritable(job.output);
        progress_.begin(fmt::format("choosing settings for {}", job.config.file.string()));
        job.config = options_.keepQuality(session_, job.config, options_.overrides, job.output);
        job.config.output.path = job.output;
        progress_.end();
        statistics_.promise(job.config.promise);
    }

    /// Runs `work`; with --keep-going it reports and counts what that throws. False if it threw.
    bool attempt(const std::filesystem::path& path, int frame, const auto& work) {
        if (!options_.keepGoing) return work(), true;
        std::vector<Error> errors;
        collect(errors, work);
        if (errors.empty()) return true;
        const std::lock_guard lock(mutex_);
        for (const auto& error : errors) {
            log::error("{}", error.message);
            if (failed_++ == 0) firstFailure_ = error.code;
        }
        statistics_.add({path, frame, FrameOutcome::failed, {}, 0, errors.front().message, {}});
        return false;
    }

    void drawFrames(const Job& job, const std::vector<int>& frames) {
        last_ = {};
        if (!frames.empty()) requireWritable(framePath(job.output, frames.front()));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const std::optional<int> next = i + 1 < frames.size() ? std::optional(frames[i + 1]) : std::nullopt;
            const auto path = framePath(job.output, frames[i]);
            if (attempt(path, frames[i], [&] { drawFrame(job, path, frames[i], next, frames.size() > 1); })) continue;
            last_ = {};  // it may hold a part of a picture, and so may:
            behind_.post([this] { flicker_ = {}; });
            endFrame(false);
        }
        last_ = {};
        if (frames.empty()) log::info("{}: no frame in part {}", job.config.file.string(), options_.chunk);
    }

    /// The film of a job's frames, once they are in place.
    void film(const Job& job, const std::vector<int>& frames, double fps, std::size_t failedBefore) {
        const auto& path = job.config.output.video;
        if (path.empty() || frames.empty()) return;
        if (options_.firstFrameOnly || !options_.chunk.empty() || !options_.frames.empty() || !options_.crop.empty()
            || !options_.output.empty())
            return log::info("{}: left to limn video: this run draws a part, or to another place", path.string());
        behind_.wait();
        if (failures() > failedBefore) return log::warning("{}: not made, since frames failed", path.string());
        std::vector<std::filesystem::path> files;
        files.reserve(frames.size());
        for (const int frame : frames) files.push_back(framePath(job.output, frame));
        progress_.begin(path.string());
        const auto begun = Clock::now();
        makeVideo(files, path, {fps});
        progress_.end();
        log::info("Saved: '{}' ({:.1f} ms)", path.string(), since(begun));
    }

    void drawFrame(
        const Job& job, const std::filesystem::path& path, int frame, std::optional<int> next, bool several) {
        const auto files = frameFiles(path, job.config.output.aovs);
        progress_.begin(path.string(), true);
        current_ = {path, frame};
        if (options_.resume && areCurrent(files, session_.identify(job.config, frame, job.crop).metadata)) {
            log::info("Kept: '{}' is complete and current", path.string());
            statistics_.add({path, frame, FrameOutcome::kept, {}, 0, {}, {}});
            succeed();
            return endFrame(false);
        }
        const int height = job.crop.size.x > 0 ? job.crop.size.y : job.config.image.size.y;
        const auto task = std::make_shared<FrameTask>(FrameTask{FrameWriter(files, job.config.output.encode, height),
            {path, frame, FrameOutcome::drawn, {}, 0, {}, {}}, done_ == 0 ? start_ : Clock::now()});
        task->followsLast = lastDrawn_ == std::pair(&job, frame - 1);
        lastDrawn_ = {&job, frame};
        const ContentKey pixels = several ? session_.pixelsKey(job.config, frame) : ContentKey();
        if (several && job.config.image.shutter == 0 && pixels == last_.pixels && !last_.bands.empty()) {
            repeat(job, frame, task);
        } else {
            last_ = {pixels, {}};
            drawNew(job, frame, next, several, task);
        }
        post(task, [this, task] { finish(*task); });
        endFrame(true);
    }

    void endFrame(bool wasDrawn) {
        progress_.end();
        progress_.frameDone(wasDrawn);
        if (wasDrawn) ++done_;
    }

    /// Writes the last frame's pixels as another frame.
    void repeat(const Job& job, int frame, const SharedTask& task) {
        task->report.outcome = FrameOutcome::same;
        const Metadata metadata = session_.identify(job.config, frame, job.crop).metadata;
        for (const auto& band : last_.bands)
            post(task, [this, task, band, metadata] { encode(*task, *band, metadata); });
    }

    void drawNew(const Job& job, int frame, std::optional<int> next, bool several, const SharedTask& task) {
        RenderOptions wanted;
        wanted.crop = job.crop;
        std::size_t kept = 0;
        // Encodes behind the drawing, so that memory does not hold the picture twice.
        wanted.onBand = [&](RenderedFrame& drawn) {
            auto band = std::make_shared<RenderedFrame>();
            band->opaque = drawn.opaque;
            band->metadata = drawn.metadata;
            band->drawing = drawn.drawing;
            for (auto& layer : drawn.layers) {
                kept += layer.image.pixels.size() * sizeof(float);
                band->layers.push_back(layer);
                layer.image = {};
            }
            if (several && kept <= kMostKept)
                last_.bands.push_back(band);
            else
                last_.bands.clear();
            post(task, [this, task, band] { encode(*task, *band, band->metadata); });
        };
        wanted.onProgress = [&](double share) {
            progress_.reach(share);
            if (options_.frameTimeout > 0 && since(task->begun) > 1000 * options_.frameTimeout)
                throw Error(ExitCode::transient, {task->report.file.string()},
                    fmt::format("took longer than {} s", options_.frameTimeout), "raise --frame-timeout, or try again");
        };
        if (next) wanted.onScene = [&] { session_.makeAhead(job.config, *next); };
        RenderedFrame rendered = session_.draw(job.config, frame, wanted);
        if (kept > kMostKept) last_.bands.clear();
        if (rendered.nonFinite > 0) tellNonFinite(rendered.nonFinite, task->report.file);
        task->report.parts = std::move(rendered.times);
        if (done_ == 0)
            task->report.parts.insert(task->report.parts.begin(),
                {{"device", deviceMilliseconds_},
                    {"load, beyond the device", std::max(0.0, loadMilliseconds_ - deviceMilliseconds_)}});
    }

    /// A step of a frame's writing, in its turn. After a step that failed none of the frame's follows.
    void post(const SharedTask& task, std::function<void()> step) {
        behind_.post([this, task, step = std::move(step)] {
            if (!task->isBroken) task->isBroken = !attempt(task->report.file, task->report.frame, step);
            if (task->isBroken) flicker_ = {};
        });
    }

    void encode(FrameTask& task, const RenderedFrame& band, const Metadata& metadata) {
        task.writer.add(band, metadata);
        task.hasFlicker = !options_.stats.empty() && Flicker::canBeSeen(band.layers);
        if (task.hasFlicker) flicker_.add(band.layers);
    }

    void finish(FrameTask& task) {
        if (!task.followsLast) flicker_.restart();
        if (task.hasFlicker) task.report.flicker = flicker_.endFrame();
        const auto writeStart = Clock::now();
        const auto files = task.writer.finish();
        task.report.parts.push_back({"write", since(writeStart)});
        task.report.total = since(task.begun);
        for (const auto& file : files) log::info("Saved: '{}' ({:.1f} ms)", file.string(), task.report.total);
        for (const auto& part : task.report.parts) log::debug("  {:<24} {:8.1f} ms", part.name, part.milliseconds);
        statistics_.add(task.report);
        succeed();
    }

    void succeed() {
        const std::lock_guard lock(mutex_);
        ++succeeded_;
    }

    std::size_t failures() {
        const std::lock_guard lock(mutex_);
        return failed_;
    }

    void tellNonFinite(std::uint64_t count, const std::filesystem::path& path) const {
        const auto text = fmt::format("{} values in {} are not finite numbers", count, path.string());
        if (options_.strict) throw Error(ExitCode::internal, {}, text, "please report this, with the scene");
        log::warning("{}: please report this, with the scene", text);
    }

    const RunOptions& options_;
    Clock::time_point start_ = Clock::now();
    Session& session_;
    bool keepsScenes_;
    Statistics statistics_;
    Progress progress_;
    Flicker flicker_;  ///< of the thread that encodes
    LastFrame last_;
    std::string deviceName_;
    double deviceMilliseconds_ = 0, loadMilliseconds_ = 0;  ///< since the run began
    std::mutex mutex_;                                      ///< of what failed:
    std::size_t failed_ = 0, succeeded_ = 0;
    ExitCode firstFailure_ = ExitCode::done;
    std::size_t done_ = 0;  ///< drawn, if not yet written
    std::pair<std::filesystem::path, int> current_;
    std::pair<const Job*, int> lastDrawn_{nullptr, 0};
    Behind behind_;  ///< ends first: its tasks use the rest
};

}  // namespace

ExitCode runJobs(const RunOptions& options) {
    Session session(options.session);
    return Run(options, session, false).draw();
}

ExitCode runJobs(const RunOptions& options, Session& session) { return Run(options, session, true).draw(); }

}  // namespace limn
