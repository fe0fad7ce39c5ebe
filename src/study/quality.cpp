#include "study/quality.h"

#include "base/file.h"
#include "base/install.h"
#include "base/log.h"
#include "base/text.h"
#include "settings/document.h"
#include "study/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

// A model of cost, the same everywhere: nanoseconds per pixel and sample on two cores, as tests/bench/quality.py found
// them. Only the order matters.
constexpr double kPerRay = 15, kPerFilterPass = 90;
constexpr int kRays[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512};
constexpr int kMostPasses = 3;
constexpr double kMostRays = 512;
constexpr int kFewestTrueRays = 512, kMostTrueRays = 8192;  // of what counts as the truth, over all samples

/// What was chosen for a config, and what is expected of it.
struct QualityChoice {
    Settings settings;
    double expected = 0;  ///< error or seconds
    std::string promise;  ///< "error 0.02 promised, 0.0173 expected"
};

/// Of a rectangle of pixels from the upper left.
struct Window {
    PixelRect part;
    int frame = 1;
    std::vector<float> truth;  ///< negative where no surface is
};

std::vector<PixelRect> windowsOf(glm::ivec2 size) {
    constexpr int kSide = 5;  // windows along each side
    if (std::int64_t{size.x} * size.y <= 160 * 120 || std::min(size.x, size.y) < 16 * kSide)
        return {{glm::ivec2(0), size}};
    const glm::ivec2 part = glm::min(glm::max(size / 36, glm::ivec2(24, 16)), size / kSide);
    std::vector<PixelRect> windows;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            // Within each cell at a place of its own, so that no regular thing is always missed.
            const glm::ivec2 cell(x * size.x / kSide, y * size.y / kSide), room = size / kSide - part;
            const int turn = (x * 7 + y * 11) % 16;
            windows.push_back({cell + room * glm::ivec2(turn % 4, turn / 4) / 3, part});
        }
    return windows;
}

/// Ambient occlusion of candidates in windows of a config's pictures, beside rays.
class Windows {
public:
    /// The truth is known to a third of `target`, if so many rays allow.
    Windows(Session& session, const StudyConfig& study, const std::vector<int>& frames, double target)
        : session_(session), study_(study) {
        const RenderConfig config = study_.at({}).config;
        for (const int frame : frames)
            for (const auto& part : windowsOf(config.image.size)) windows_.push_back({part, frame, {}});
        int rays = kFewestTrueRays;
        findTruth(config.image.samples, rays);
        // Too few windows show a surface to say anything about the others: then the whole picture is looked at.
        const auto shows = [](const Window& window) {
            return std::any_of(window.truth.begin(), window.truth.end(), [](float v) { return v >= 0; });
        };
        constexpr std::ptrdiff_t kFewestWindows = 5;
        if (std::count_if(windows_.begin(), windows_.end(), shows) < kFewestWindows) {
            windows_.clear();
            for (const int frame : frames) windows_.push_back({{glm::ivec2(0), config.image.size}, frame, {}});
        }
        for (findTruth(config.image.samples, rays); trueError_ > target / 3 && rays < kMostTrueRays;)
            findTruth(config.image.samples, rays *= 4);
    }

    struct Error {
        double rmse = 0, spread = 0;  ///< standard error of that, as windows differ
    };

    /// Standard error of the truth.
    double trueError() const { return trueError_; }

    Error errorOf(const Settings& settings) {
        const Variant variant = study_.at(settings);
        std::vector<double> squares, counts;
        for (const auto& window : windows_) {
            const auto seen = draw(variant, window);
            double sum = 0, count = 0;
            for (std::size_t i = 0; i < seen.size(); ++i) {
                if (window.truth[i] < 0) continue;
                sum += std::pow(static_cast<double>(seen[i]) - static_cast<double>(window.truth[i]), 2);
                ++count;
            }
            squares.push_back(sum);
            counts.push_back(count);
        }
        return spreadOf(squares, counts);
    }

private:
    /// The root of the mean square, and by leaving out each window in turn its standard error.
    Error spreadOf(const std::vector<double>& squares, const std::vector<double>& counts) const {
        double all = 0, count = 0, spread = 0;
        for (std::size_t i = 0; i < squares.size(); ++i) all += squares[i], count += counts[i];
        if (count == 0) return {};
        const auto without = [&](double sum, double n) {
            return std::sqrt(std::max(0.0, sum / n - trueError_ * trueError_));
        };
        const double rmse = without(all, count);
        const auto n = static_cast<double>(squares.size());
        for (std::size_t i = 0; i < squares.size(); ++i)
            if (counts[i] > 0 && count > counts[i])
                spread += std::pow(without(all - squares[i], count - counts[i]) - rmse, 2) * (n - 1) / n;
        return {rmse, std::sqrt(spread)};
    }

    void findTruth(int samples, int allRays) {
        const int rays = std::max(1, allRays / (2 * samples));
        Settings traced = *study_.tracedOcclusion(rays);
        traced["image.ao_samples"] = std::to_string(samples);
        traced["image.seed"] = Halves::kSeeds[0];
        const Variant one = study_.at(traced);
        traced["image.seed"] = Halves::kSeeds[1];
        const Variant other = study_.at(traced);
        Halves halves;
        for (auto& window : windows_) {
            RenderConfig surface = one.config;
            surface.image.samples = 1;
            surface.output.aovs = {&aov::depth};
            window.truth = draw(one, window);
            halves.join(window.truth, draw(other, window), drawPart(surface, *one.scene, window));
        }
        trueError_ = halves.standardError();
    }

    std::vector<float> draw(const Variant& variant, const Window& window) {
        RenderConfig config = variant.config;
        config.output.aovs = {&aov::ambientOcclusion};
        return drawPart(config, *variant.scene, window);
    }

    std::vector<float> drawPart(const RenderConfig& config, const LoadedScene& scene, const Window& window) {
        RenderOptions options;
        options.crop = window.part;
        return session_.renderer().render(config, scene, window.frame, options).layers[0].image.pixels;
    }

    Session& session_;
    const StudyConfig& study_;
    std::vector<Window> windows_;
    double trueError_ = 0;
};

/// Settings for so many rays and passes of a filter (0: none).
Settings tracedWith(const StudyConfig& study, int rays, int passes) {
    Settings settings = *study.tracedOcclusion(rays);
    if (passes > 0) settings["ao.filter"] = fmt::format("{{ technique = \"plane_aware\", passes = {} }}", passes);
    return settings;
}

double costOf(int rays, int passes) { return rays * kPerRay + passes * kPerFilterPass; }

QualityChoice chooseByError(
    Session& session, const StudyConfig& study, const RenderConfig& config, const std::vector<int>& frames) {
    const double target = config.quality.error;
    if (!study.tracedOcclusion(1))
        throw Error(ExitCode::usage, {config.file.string()},
            "quality.error is about ambient occlusion, and this config draws none that rays could check",
            "add [ao] with a technique that has a radius, strength 1 and no keyframes, or take quality.seconds");
    log::info("quality: looks for settings with an error of at most {}", target);
    Windows windows(session, study, frames, target);
    // Windows are a part of the picture: a margin of so many standard errors leaves room for the rest.
    const auto bound = [&](const Windows::Error& error) {
        return std::max(error.rmse + 1.64 * error.spread, windows.trueError());
    };
    struct Found {
        double cost = 1e300, rmse = 0;
        Settings settings;
    } best;
    double lowest = 1e300;
    for (int passes = kMostPasses; passes >= 0; --passes) {
        // More rays are better: the fewest that are enough, by halving.
        std::size_t low = 0, high = std::size(kRays);
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (costOf(kRays[middle], passes) >= best.cost) {
                high = middle;
                continue;
            }
            const Settings settings = tracedWith(study, kRays[middle], passes);
            const auto error = windows.errorOf(settings);
            lowest = std::min(lowest, bound(error));
            if (bound(error) > target) {
                low = middle + 1;
                continue;
            }
            best = {costOf(kRays[middle], passes), error.rmse, settings};
            high = middle;
        }
    }
    if (best.settings.empty())
        throw Error(ExitCode::usage, {config.file.string()},
            fmt::format(
                "quality.error = {} cannot be promised: the best that was found comes to {:.4f}", target, lowest),
            "ask for more than that, or raise image.samples");
    return {best.settings, best.rmse, fmt::format("error {} promised, {:.4f} expected", target, best.rmse)};
}

/// Settings from cheap to dear, each better than the one before it; rays: 0 without ambient occlusion.
struct Step {
    int samples, rays;
};
constexpr Step kSteps[] = {{1, 1}, {1, 2}, {2, 2}, {4, 2}, {4, 4}, {8, 4}, {8, 8}, {8, 16}, {16, 16}, {16, 32},
    {32, 32}, {32, 64}, {64, 64}, {64, 128}, {128, 128}, {256, 128}};

Settings settingsFor(const StudyConfig& study, const Step& step) {
    Settings settings;
    if (study.tracedOcclusion(1)) settings = tracedWith(study, step.rays, 2);
    settings["image.samples"] = std::to_string(step.samples);
    return settings;
}

QualityChoice chooseBySeconds(
    Session& session, const StudyConfig& study, const RenderConfig& config, const std::vector<int>& frames) {
    const double target = config.quality.seconds;
    const bool hasOcclusion = study.tracedOcclusion(1).has_value();
    const auto timed = [&](const Step& step, int frame) {
        const Variant variant = study.at(settingsFor(study, step));
        double seconds = 0;
        for (const auto& part : session.renderer().render(variant.config, *variant.scene, frame, {}).times)
            if (part.name == "draw") seconds += part.milliseconds / 1000;
        return seconds;
    };
    double beginning = 0;
    const auto secondsOf = [&](const Step& step) {
        double slowest = 0;
        for (const int frame : frames) slowest = std::max(slowest, timed(step, frame));
        return slowest + beginning;
    };
    log::info("quality: looks for settings that take {} s a frame", target);
    secondsOf(kSteps[0]);  // compiles and uploads
    if (frames.size() == 1) {
        // A still is a process's first frame: what that takes longer, once its shaders are in the driver's cache.
        session.restart();
        const double first = timed(kSteps[0], frames.front());
        beginning = std::max(0.0, first - secondsOf(kSteps[0]));
    }
    // Draws dearer and dearer settings; what a step costs more tells where to stop.
    std::size_t at = 0;
    double seconds = secondsOf(kSteps[0]);
    if (seconds > target)
        throw Error(ExitCode::usage, {config.file.string()},
            fmt::format("quality.seconds = {} cannot be kept: the fastest settings take {:.2f} s", target, seconds),
            "ask for more, or make the picture smaller");
    double before = seconds;
    while (at + 1 < std::size(kSteps) && seconds < target) {
        before = seconds;
        seconds = secondsOf(kSteps[++at]);
    }
    Step step = kSteps[at];
    if (seconds > target && at > 0) {
        // What is left of the time goes into rays, or where there are none into samples.
        const Step cheap = kSteps[at - 1];
        const Step dear = hasOcclusion ? Step{cheap.samples, 4 * cheap.rays} : step;
        const double slope = std::max(secondsOf(dear) - before, 1e-9);
        double share = std::max(0.0, (0.97 * target - before) / slope);
        const auto between = [&](int a, int b) {
            return a + static_cast<int>(std::min(share, kMostRays / static_cast<double>(b)) * (b - a));
        };
        for (int tries = 0; tries < 3 && seconds > target; ++tries) {
            step = {between(cheap.samples, dear.samples), between(cheap.rays, dear.rays)};
            seconds = secondsOf(step);
            share *= 0.9;
        }
        if (seconds > target) step = cheap, seconds = before;
    }
    return {settingsFor(study, step), seconds, fmt::format("{} s promised, {:.2f} s expected", target, seconds)};
}

/// Up to three frames, spread over all that the config draws.
std::vector<int> telling(const RenderConfig& config, const LoadedScene& loaded) {
    const auto range = config.frames ? config.frames : loaded.scene.frames;
    if (!range || range->first == range->last) return {range ? range->first : loaded.scene.firstFrame()};
    std::vector<int> frames{range->first, (range->first + range->last) / 2, range->last};
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

ContentKey keyOf(Session& session, const RenderConfig& config, const std::vector<int>& frames) {
    KeyBuilder key;
    key.add(std::string_view(kVersion)).add(config.hash);
    for (const int frame : frames) {
        const ContentKey pixels = session.pixelsKey(config, frame);
        key.add(frame).add(pixels.low).add(pixels.high);
    }
    return key.key();
}

std::optional<QualityChoice> readChoice(const std::filesystem::path& file, const std::string& key) {
    if (!fileExists(file)) return std::nullopt;
    const Node document = readDocument(file);
    const Node *known = document.find("key"), *settings = document.find("settings"),
               *promise = document.find("promise"), *expected = document.find("expected");
    const bool isWhole = known && known->text() && settings && settings->isTable() && promise && promise->text()
        && expected && expected->isNumber();
    if (!isWhole || *known->text() != key) return std::nullopt;
    QualityChoice choice;
    for (const auto& [name, value] : settings->table())
        if (value.text()) choice.settings[name] = *value.text();
    choice.expected = expected->number();
    choice.promise = *promise->text();
    return choice;
}

std::string textOf(const QualityChoice& choice, const std::string& key, const std::string& lines) {
    std::string text =
        fmt::format("# Chosen by limn: {}. It is chosen anew when the config or its scene changes.\n", choice.promise);
    std::string comment;
    for (const char c : lines)
        comment += (comment.empty() || comment.back() == '\n' ? "#     " : "") + std::string(1, c);
    text += "# These lines in the config, in place of quality, do the same:\n" + comment;
    text += fmt::format("key = {}\nexpected = {}\npromise = {}\n[settings]\n", jsonText(key),
        choice.expected > 0 ? fmt::format("{:.9f}", choice.expected) : "0.0", jsonText(choice.promise));
    for (const auto& [name, value] : choice.settings) text += fmt::format("{} = {}\n", jsonText(name), jsonText(value));
    return text;
}

/// Chooses settings, or takes them from `kept` where that was made for the same config and scene; writes it otherwise.
QualityChoice chooseQuality(
    Session& session, const RenderConfig& config, const ConfigOverrides& overrides, const std::filesystem::path& kept) {
    const LoadedScene& loaded = session.load(config);
    const auto frames = telling(config, loaded);
    const std::string key = keyOf(session, config, frames).hex();
    if (auto known = readChoice(kept, key)) {
        log::info("quality: {} ({})", known->promise, kept.string());
        return *known;
    }
    Node document = readConfigDocument(config.file);
    layerSettings(document, overrides.settings);
    if (!config.camera.empty()) applySetting(document, "camera=" + jsonText(config.camera));
    const StudyConfig study(std::move(document), config.file, loaded, config.meshFile);
    QualityChoice choice = config.quality.error > 0 ? chooseByError(session, study, config, frames)
                                                    : chooseBySeconds(session, study, config, frames);
    replaceFile(kept, textOf(choice, key, study.lines(choice.settings)));
    log::info("quality: {}: {}", choice.promise, settingsText(choice.settings));
    return choice;
}

/// "walk_####.png" of walk.toml → "walk.walk.quality.toml": configs with one output do not share it.
std::filesystem::path qualityFile(const std::filesystem::path& output, const std::filesystem::path& config) {
    std::string stem = output.stem().string();
    std::erase(stem, '#');
    while (stem.size() > 1 && (stem.back() == '_' || stem.back() == '.' || stem.back() == '-')) stem.pop_back();
    return output.parent_path() / fmt::format("{}.{}.quality.toml", stem, config.stem().string());
}

}  // namespace

RenderConfig withQuality(Session& session, const RenderConfig& config, const ConfigOverrides& overrides,
    const std::filesystem::path& output) {
    const QualityChoice choice = chooseQuality(session, config, overrides, qualityFile(output, config.file));
    ConfigOverrides all = overrides;
    for (const auto& [key, value] : choice.settings) all.settings.push_back(fmt::format("{}={}", key, value));
    RenderConfig kept = readRenderConfig(config.file, all);
    kept.camera = config.camera;
    kept.promise = choice.promise;
    return kept;
}

}  // namespace limn
