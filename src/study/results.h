// What a study leaves behind: figures as JSON and CSV, the front as SVG, and one page that needs nothing else.
#pragma once

#include "study/sweep.h"

#include <filesystem>

namespace limn {

/// Writes the pictures of a point into `folder`/pictures; none without pictures.
void writePictures(const std::filesystem::path& folder, const StudyPoint& point, const PointPictures& pictures);

/// pictures/truth.png and pictures/truth_occlusion.png.
void writeTruth(const std::filesystem::path& folder, const Image& picture, const Image& occlusion);

/// study.json: everything that a later run needs to go on.
void writeFigures(const std::filesystem::path& folder, const SweepReport& report);
/// What `folder` knows of a study with this identity; nothing where there is no such study, or it cannot be read.
void readFigures(const std::filesystem::path& folder, const std::string& identity, SweepHooks& hooks);

/// The front as a drawing that stands by itself.
std::string frontSvg(const SweepReport& report);

/// study.json, study.csv, front.svg and index.html.
void writeResults(const std::filesystem::path& folder, const SweepReport& report);

}  // namespace limn
