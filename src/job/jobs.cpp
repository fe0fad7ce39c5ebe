#include "job/jobs.h"

#include "base/file.h"
#include "base/log.h"
#include "job/frames.h"
#include "job/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace limn {
namespace {

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

/// Throws Error where a vector file would hold nothing but an image.
void checkVectors(const RenderConfig& config, bool isCropped) {
    const auto& layers = config.in("edges");
    if (std::none_of(
            layers.begin(), layers.end(), [](const auto& choice) { return choice.technique->vectorLines != nullptr; }))
        throw Error(ExitCode::usage, {config.file.string()}, "none of its lines can be drawn as vectors",
            "add [[edges]] with technique = \"mesh_lines\", or end the path in .png");
    if (std::find(config.output.aovs.begin(), config.output.aovs.end(), &aov::beauty) == config.output.aovs.end())
        throw Error(ExitCode::usage, {config.file.string()}, "a vector file is the picture, which 'aovs' leaves out",
            "add \"beauty\" to output.aovs");
    if (isCropped)
        throw Error(ExitCode::usage, {config.file.string()}, "a drawing cannot be cropped",
            "leave --crop out; vector programs crop without loss");
}

Job readJob(const std::string& path, const RunOptions& options, const std::vector<Job>& before) {
    Job job{readRenderConfig(path, options.overrides), {}, {}};
    job.output = outputPath(job.config, options.output, options.configs.size() > 1);
    for (const auto& other : before)
        if (other.output.lexically_normal() == job.output.lexically_normal())
            throw Error(ExitCode::usage, {path},
                fmt::format("would write the same file as '{}': '{}'", other.config.file.string(), job.output.string()),
                "put {config} into --output, or give each its own output.path");
    job.config.output.path = job.output;
    if (imageFormat(job.output)->traits.isVector) checkVectors(job.config, !options.crop.empty());
    if (job.config.image.transparent && imageFormat(job.output)->traits.isOpaque)
        log::warning(
            "{}: '{}' cannot be transparent: its background comes out black; end the path in .png, .tif or .exr", path,
            job.output.string());
    const auto& video = job.config.output.video;
    if (!video.empty()) {
        requireVideo(video);
        requireWritable(video);
    }
    for (const auto& other : before)
        if (!video.empty() && other.config.output.video.lexically_normal() == video.lexically_normal())
            throw Error(ExitCode::usage, {path},
                fmt::format("would write the same film as '{}': '{}'", other.config.file.string(), video.string()),
                "give each its own output.video");
    if (!options.crop.empty()) job.crop = parseCrop(options.crop, job.config.image.size);
    return job;
}

/// Frames that no scene declares are drawn, with what the nearest declared one shows; asking for them may be a slip.
void tellBeyond(const Job& job, const LoadedScene& loaded, const std::vector<int>& frames) {
    const auto& declared = loaded.scene.frames;
    if (!declared) return;
    const auto beyond = std::count_if(
        frames.begin(), frames.end(), [&](int frame) { return frame < declared->first || frame > declared->last; });
    if (beyond > 0)
        log::warning("{}: {} of {} frames lie beyond {}-{}, which the scene declares", job.config.scene.string(),
            beyond, frames.size(), declared->first, declared->last);
}

}  // namespace

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

std::vector<int> framesOf(const Job& job, const RunOptions& options, const LoadedScene& loaded) {
    std::vector<int> frames = framesOf(job.config, options.frames, loaded.scene.frames);
    if (options.firstFrameOnly) frames.resize(1);
    if (frames.size() > 1 && !hasFrameNumber(job.output))
        throw Error(ExitCode::usage, {job.output.string()},
            fmt::format("{} frames would be written to one file", frames.size()),
            "put #### into the path: room_####.png");
    tellBeyond(job, loaded, frames);
    return options.chunk.empty() ? frames : chunkOf(frames, options.chunk);
}

}  // namespace limn
