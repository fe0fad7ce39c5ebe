#include "study/sweep.h"

#include "base/log.h"
#include "base/text.h"
#include "job/frames.h"
#include "render/identity.h"
#include "settings/document.h"
#include "study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace limn {
namespace {

constexpr Field kSweep[] = {
    field<&SweepSettings::cameras>("cameras", "Names of the cameras to study from; the config's if left out."),
    field<&SweepSettings::frames>("frames", "Frames to study, such as \"1,12\"; the first if left out."),
    field<&SweepSettings::knobs>("knobs", "Patterns of the settings to turn, such as \"ao.*\"; all if left out."),
    field<&SweepSettings::techniques>("techniques", {.keyable = false}, "Try other techniques of ambient occlusion."),
    field<&SweepSettings::samples>(
        "samples", {.min = 1, .max = 4096, .keyable = false}, "Samples per pixel of the true picture."),
    field<&SweepSettings::rays>(
        "rays", {.min = 64, .max = 65536, .keyable = false}, "Rays per pixel of true ambient occlusion."),
    field<&SweepSettings::repeat>(
        "repeat", {.min = 1, .max = 1000, .keyable = false}, "Timed runs of each setting; their median counts."),
    field<&SweepSettings::seconds>("seconds", {.min = 1, .keyable = false}, "Time to spend, the truth aside."),
};

std::string shotName(const Shot& shot) {
    return fmt::format("{}frame {}", shot.camera.empty() ? "" : "camera " + shot.camera + ", ", shot.frame);
}

/// "hbao, plane_aware"
std::string groupOf(const RenderConfig& config) {
    std::string group;
    for (const char* slot : {"ao", "filter"})
        for (const auto& choice : config.in(slot))
            group += (group.empty() ? "" : ", ") + std::string(choice.technique->name);
    return group.empty() ? "config" : group;
}

class Sweeper {
public:
    Sweeper(Session& session, const StudyConfig& study, const SweepSettings& settings, std::vector<Shot> shots,
        SweepHooks& hooks, SweepReport& report)
        : study_(study),
          settings_(settings),
          hooks_(hooks),
          report_(report),
          measurer_(session, study, settings, std::move(shots)) {}

    void run() {
        try_({}, "config", "");
        const bool byOcclusion = report_.hasOcclusion();
        if (settings_.techniques)
            for (const auto& other : study_.alternatives()) try_(other, "technique", "");
        for (const auto& knob : allowed(study_.knobs({}, frame())))
            for (std::size_t v = 0; v < knob.values.size(); ++v)
                if (v != knob.current) try_({{knob.key, knob.values[v]}}, "knob", knob.key);
        refine(byOcclusion);
        if (byOcclusion) splitFront();
        report_.points.insert(report_.points.end(), report_.others.begin(), report_.others.end());
        report_.others.clear();
        if (untried_ > 0)
            report_.notes.push_back(fmt::format(
                "the time ended with {} setting{} untried; --budget gives more", untried_, untried_ == 1 ? "" : "s"));
    }

private:
    int frame() const { return measurer_.shots().front().frame; }

    std::vector<Knob> allowed(std::vector<Knob> knobs) const {
        std::erase_if(knobs, [&](const Knob& knob) {
            return !settings_.knobs.empty()
                && std::none_of(settings_.knobs.begin(), settings_.knobs.end(),
                    [&](const auto& pattern) { return fitsPattern(pattern, knob.key); });
        });
        return knobs;
    }

    /// Different settings may come to the same config.
    std::string identityOf(const Settings& settings) const {
        std::string identity = study_.at(settings).config.hash;
        for (const auto& [key, value] : settings)
            if (key.starts_with("scene.")) identity += fmt::format(" {}={}", key, value);
        return identity;
    }

    /// Measures a setting unless it is known, or time is up.
    void try_(const Settings& settings, const std::string& kind, const std::string& knob) {
        if (!tried_.insert(identityOf(settings)).second) return;
        const auto known = std::find_if(hooks_.known.begin(), hooks_.known.end(),
            [&](const StudyPoint& point) { return point.settings == settings; });
        if (known != hooks_.known.end()) {
            report_.points.push_back(*known);
            std::erase_if(report_.others, [&](const StudyPoint& point) { return point.settings == settings; });
            return;
        }
        if (spent_ > settings_.seconds && !report_.points.empty()) {
            ++untried_;
            return;
        }
        PointPictures pictures;
        try {
            if (report_.points.empty()) measurer_.tryDrawing(settings);
            StudyPoint point = measurer_.measure(settings, pictures);
            if (hooks_.onTruth && !std::exchange(isTruthTold_, true)) {
                const auto [picture, occlusion] = measurer_.truePictures();
                hooks_.onTruth(picture, occlusion);
            }
            point.kind = kind;
            point.knob = knob;
            point.group = groupOf(study_.at(settings).config);
            KeyBuilder key;
            point.name = key.add(settingsText(settings)).key().hex().substr(0, 12);
            // The truth is made once, and is no part of what is measured.
            spent_ += (point.first + point.milliseconds * (point.runs + 2)) / 1000
                * static_cast<double>(measurer_.shots().size());
            if (measurer_.truthError() > 0) report_.truthError = measurer_.truthError();
            report_.points.push_back(std::move(point));
        } catch (const Error& error) {
            if (report_.points.empty()) throw;
            report_.notes.push_back(fmt::format("{}: {}", settingsText(settings), error.problem));
            return;
        }
        hooks_.onPoint(report_, report_.points.back(), pictures);
        tellProgress();
    }

    void tellProgress() const {
        const StudyPoint& point = report_.points.back();
        const std::string occlusion = point.occlusion ? fmt::format("   occlusion {:.4f}", point.occlusion->rmse) : "";
        log::info("{:>3}  {:8.1f} ms   picture {:.4f}{}   {}   ({:.0f} of {:.0f} s)", report_.points.size(),
            point.milliseconds, point.picture.rmse, occlusion, presentable(settingsText(point.settings)), spent_,
            settings_.seconds);
    }

    /// Walks along the front: each of its points has neighbours one step of one knob away.
    void refine(bool byOcclusion) {
        for (bool found = true; found && spent_ <= settings_.seconds;) {
            const std::size_t before = report_.points.size();
            std::set<std::size_t> best;
            for (const bool which : {byOcclusion, false})
                for (const auto i : paretoFront(report_.points, which)) best.insert(i);
            // From both ends: what is cheap, and what is right.
            std::vector<std::size_t> order(best.begin(), best.end());
            std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
                return report_.points[a].milliseconds < report_.points[b].milliseconds;
            });
            for (std::size_t k = 0; k < order.size(); ++k) {
                const std::size_t i = k % 2 == 0 ? order[order.size() - 1 - k / 2] : order[k / 2];
                const Settings at = report_.points[i].settings;
                if (settings_.techniques && byOcclusion)
                    for (const auto& filtered : study_.otherFilters(at)) try_(filtered, "refined", "");
                for (const auto& knob : allowed(study_.knobs(at, frame()))) {
                    if (knob.current > 0) tryValue(at, knob, knob.current - 1);
                    if (knob.current + 1 < knob.values.size()) tryValue(at, knob, knob.current + 1);
                }
            }
            found = report_.points.size() > before;
        }
    }

    void tryValue(Settings settings, const Knob& knob, std::size_t value) {
        settings[knob.key] = knob.values[value];
        const bool isNeutral = knob.values[value] == (knob.key == "scene.subdivision.level" ? "0" : "1");
        if (knob.key.starts_with("scene.") && isNeutral) settings.erase(knob.key);  // as the scene is
        try_(settings, "refined", "");
    }

    void splitFront() {
        for (const auto i : paretoFront(report_.points, true)) {
            if (report_.points[i].split) continue;
            report_.points[i].split = measurer_.split(report_.points[i].settings);
            hooks_.onPoint(report_, report_.points[i], {});
        }
    }

    const StudyConfig& study_;
    const SweepSettings& settings_;
    SweepHooks& hooks_;
    SweepReport& report_;
    Measurer measurer_;
    std::set<std::string> tried_;
    double spent_ = 0;
    bool isTruthTold_ = false;
    std::size_t untried_ = 0;
};

}  // namespace

double errorOf(const StudyPoint& point, bool byOcclusion) {
    return byOcclusion && point.occlusion ? point.occlusion->rmse : point.picture.rmse;
}

std::vector<std::size_t> paretoFront(const std::vector<StudyPoint>& points, bool byOcclusion) {
    std::vector<std::size_t> order, front;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!byOcclusion || points[i].occlusion) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(points[a].milliseconds, errorOf(points[a], byOcclusion))
            < std::pair(points[b].milliseconds, errorOf(points[b], byOcclusion));
    });
    for (const auto i : order)
        if (front.empty() || errorOf(points[i], byOcclusion) < errorOf(points[front.back()], byOcclusion))
            front.push_back(i);
    return front;
}

FrontFit fitFront(const std::vector<StudyPoint>& points, std::span<const std::size_t> front, bool byOcclusion) {
    FrontFit fit;
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto i : front) {
        const double error = errorOf(points[i], byOcclusion);
        if (!(error > 0)) continue;
        const double a = std::log10(points[i].milliseconds), b = std::log10(error);
        x += a, y += b, xx += a * a, xy += a * b;
        ++fit.points;
    }
    const double n = fit.points, spread = n * xx - x * x;
    constexpr int kFewest = 4;
    constexpr double kNarrowest = 3;  // of times: a law needs room to show itself
    if (fit.points < kFewest || points[front.back()].milliseconds < kNarrowest * points[front.front()].milliseconds)
        return {};
    fit.exponent = (n * xy - x * y) / spread;
    const double intercept = (y - fit.exponent * x) / n;
    fit.factor = std::pow(10.0, intercept);
    double squares = 0;
    for (const auto i : front)
        if (const double error = errorOf(points[i], byOcclusion); error > 0)
            squares += std::pow(std::log10(error) - intercept - fit.exponent * std::log10(points[i].milliseconds), 2);
    fit.spread = std::sqrt(squares / std::max(1.0, n - 2));
    return fit;
}

std::vector<SettingsTable> sweepTables() {
    return {{"[study]", "what limn study looks at; pictures do not depend on it", kSweep, defaultsOf<SweepSettings>()}};
}

SweepSettings takeSweepSettings(Node& document) {
    SweepSettings settings;
    ErrorCollector errors;
    if (const Node* study = document.find("study")) {
        readFields(*study, kSweep, &settings, nullptr, "[study]", errors);
        errors.throwIfAny();
        std::erase_if(std::get<Node::Table>(document.value), [](const auto& entry) { return entry.first == "study"; });
    }
    return settings;
}

static std::vector<Shot> shotsOf(const RenderConfig& config, const LoadedScene& loaded, const SweepSettings& settings) {
    std::vector<int> frames = framesOf(config, settings.frames, loaded.scene.frames);
    if (settings.frames.empty()) frames.resize(1);
    std::vector<Shot> shots;
    for (const int frame : frames) {
        if (settings.cameras.empty()) shots.push_back({"", frame});
        for (const auto& camera : settings.cameras) shots.push_back({camera, frame});
    }
    return shots;
}

std::string sweepIdentity(Session& session, const RenderConfig& config, const SweepSettings& settings) {
    KeyBuilder key;
    const LoadedScene& loaded = session.load(config);
    for (const Shot& shot : shotsOf(config, loaded, settings)) {
        RenderConfig shown = config;
        if (!shot.camera.empty()) shown.camera = shot.camera;
        for (const auto& [name, value] : session.identify(shown, shot.frame, {}).metadata) key.add(name).add(value);
    }
    key.add(settings.samples).add(settings.rays).add(settings.repeat);
    return key.key().hex();
}

SweepReport runSweep(Session& session, Node document, const std::filesystem::path& path, const SweepSettings& settings,
    SweepHooks hooks) {
    const RenderConfig config = parseRenderConfig(document, path);
    const LoadedScene& loaded = session.load(config);
    const StudyConfig study(std::move(document), path, loaded);
    const auto shots = shotsOf(config, loaded, settings);
    SweepReport report;
    report.config = path.string();
    report.scene = config.scene.string();
    report.device = session.renderer().device().report().renderer;
    report.identity = sweepIdentity(session, config, settings);
    report.size = config.image.size;
    report.others = hooks.known;
    report.truthError = hooks.knownTruthError;
    for (const auto& shot : shots) report.shots.push_back(shotName(shot));
    Sweeper(session, study, settings, shots, hooks, report).run();
    return report;
}

}  // namespace limn
