// Accuracy against time for one config: every knob that its plan contains is turned, and each setting is timed and
// compared with the truth. Settings come in the order in which they tell most: the config as it is, other techniques,
// its knobs one by one, then the neighbours of what was best so far.
//
// A study file is a render config, or includes one, and may narrow the study:
//
//     include = ["room.toml"]
//     [study]
//     cameras = ["A", "B"]
//     frames = "1,12"
//     knobs = ["ao.*", "image.samples"]
#pragma once

#include "study/knobs.h"
#include "study/truth.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limn {

struct SweepSettings {
    std::vector<std::string> cameras;  ///< empty: the config's
    std::string frames;                ///< as for --frames; empty: the first
    std::vector<std::string> knobs;    ///< patterns; empty: all
    bool techniques = true;            ///< exchange techniques too
    int samples = 256;                 ///< of the true picture
    int rays = 1024;                   ///< of true ambient occlusion, per pixel, over all samples
    int repeat = 9;                    ///< timed runs of each setting
    double seconds = 600;              ///< budget
};

/// Errors of ambient occlusion, over pixels that show a surface; visibility, 0 … 1.
struct OcclusionError : Deviation {
    double inside = 0, silhouette = 0, border = 0;  ///< root mean square, by PixelClass
};

/// Where an error of ambient occlusion comes from: root mean squares. Their squares add up to the whole's, but for what
/// the parts have in common.
struct ErrorSplit {
    double unseen = 0;     ///< what the depth buffer cannot know: rays against its own triangles, beside the truth
    double estimator = 0;  ///< what the technique misses on average: its mean over seeds beside those rays
    double sampling = 0;   ///< what chance adds: the spread between seeds
};

/// Distance from the limit surface, in pixels, along the normal.
struct GeometryError {
    double rmse = 0, p99 = 0;
};

/// Pictures of the first camera, as files.
struct PointPictures {
    Image beauty, beautyError;        ///< linear colours; error: display values
    Image occlusion, occlusionError;  ///< empty without ambient occlusion
};

struct StudyPoint {
    Settings settings;
    std::string kind;                            ///< "config", "knob", "technique" or "refined"
    std::string knob;                            ///< the key, of a "knob"
    std::string group;                           ///< technique and filters of ambient occlusion, or "config"
    std::string lines;                           ///< StudyConfig::lines
    double milliseconds = 0, low = 0, high = 0;  ///< of drawing a frame: median and quartiles
    double first = 0;                            ///< milliseconds of the first frame, with all that is made once
    int runs = 0;
    std::vector<std::pair<std::string, double>> slots;  ///< GPU milliseconds, medians
    Deviation picture;                                  ///< display-encoded, each channel
    double similarity = 1;                              ///< of the picture's luma (study/truth.h)
    std::optional<OcclusionError> occlusion;
    std::optional<ErrorSplit> split;
    std::optional<GeometryError> geometry;
    std::string name;  ///< of its pictures' files
};

/// error ≈ factor · milliseconds^exponent, by least squares over a front, in logarithms. No points: the front is too
/// small for a law, or its times too alike.
struct FrontFit {
    double factor = 0, exponent = 0;
    double spread = 0;  ///< standard deviation of log10 error about it
    int points = 0;
};

struct SweepReport {
    std::string config, scene, device, identity;
    glm::ivec2 size{0};
    std::vector<std::string> shots;    ///< "camera A, frame 1"
    std::optional<double> truthError;  ///< standard error of true ambient occlusion, root mean square
    std::vector<StudyPoint> points;
    std::vector<StudyPoint> others;  ///< of an earlier run, not come to yet
    std::vector<std::string> notes;  ///< "the budget ended with 14 settings untried"
    bool hasOcclusion() const { return !points.empty() && points.front().occlusion.has_value(); }
};

/// Error of a point by which fronts are drawn.
double errorOf(const StudyPoint& point, bool byOcclusion);
/// The points that no other beats in time and error: indices, by time.
std::vector<std::size_t> paretoFront(const std::vector<StudyPoint>& points, bool byOcclusion);
FrontFit fitFront(const std::vector<StudyPoint>& points, std::span<const std::size_t> front, bool byOcclusion);

struct SweepHooks {
    std::vector<StudyPoint> known;  ///< from an earlier run of the same identity, as is:
    std::optional<double> knownTruthError;
    /// After each new point; the pictures are empty where there are none.
    std::function<void(const SweepReport&, const StudyPoint&, const PointPictures&)> onPoint;
    /// The true picture (display values) and ambient occlusion (empty without), once they are known.
    std::function<void(const Image&, const Image&)> onTruth;
};

/// [study], for the parameter reference.
std::vector<SettingsTable> sweepTables();
/// The [study] of a document, which is taken out of it. Throws Errors.
SweepSettings takeSweepSettings(Node& document);
/// What decides about a study's figures, but the machine's speed.
std::string sweepIdentity(Session& session, const RenderConfig& config, const SweepSettings& settings);

/// Throws what drawing throws.
SweepReport runSweep(Session& session, Node document, const std::filesystem::path& path, const SweepSettings& settings,
    SweepHooks hooks);

}  // namespace limn
