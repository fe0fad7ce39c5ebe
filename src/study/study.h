// Accuracy against time: sweeps settings of ambient occlusion over scenes and cameras, against the ray-traced truth.
//
// A study file:
//
//     [image]
//     size = [640, 360]
//     rays = 1024                 # of the truth, per pixel
//     repeat = 3                  # the fastest of so many runs counts
//
//     [[place]]
//     name = "room"
//     scene = "room/scene.toml"
//     radius = 0.5                # the same for truth and techniques
//     tune = ["A"]                # cameras that the tuner sees
//     score = ["B"]               # cameras that are reported
//
//     [[method]]
//     name = "hbao"
//     ao = { technique = "hbao", filter = "gaussian" }
//     tune = { "steps" = [4, 8, 16], "filter.iterations" = [1, 2] }   # for each place, the best of these
//     milliseconds = 15           # settings that take longer do not count
#pragma once

#include "study/truth.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace limn {

struct StudySettings {
    glm::ivec2 size{640, 360};
    int rays = 1024;
    int repeat = 3;
};

struct StudyPlace {
    std::string name, scene;
    Length radius = Length::percent(5);
    std::vector<std::string> tune, score;
};

struct StudyAxis {
    std::string key;                  ///< below [ao]
    std::vector<std::string> values;  ///< TOML
};

struct StudyMethod {
    std::string name;
    Node ao;
    std::vector<StudyAxis> axes;
    double milliseconds = 0;  ///< limit; 0 = none
};

struct Study {
    StudySettings settings;
    std::vector<StudyPlace> places;
    std::vector<StudyMethod> methods;
};

struct StudyRow {
    std::string place, camera, method, settings;  ///< settings: what the tuner chose
    Deviation truth;                              ///< against rays in the scene
    double shellRmse = 0;                         ///< against rays in the depth buffer's own triangles
    double milliseconds = 0;                      ///< of the ao and filter passes, without transfers
    double transferMilliseconds = 0;  ///< for reading images back for passes on the CPU, and sending results on
    double treeMilliseconds = 0;      ///< for building the ray tracing tree
    double microsecondsPerPixel = 0;
    Image picture, truthPicture, shellPicture;  ///< visibility; 1 on the background
};

/// Reads a study file. Every problem at once (Errors).
Study readStudy(const std::filesystem::path& path);

/// Runs the study and hands each row over as soon as it is known.
void runStudy(Session& session, const Study& study, const std::function<void(const StudyRow&)>& report);

}  // namespace limn
