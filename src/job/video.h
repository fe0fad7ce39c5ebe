// Films from finished frames, by the program ffmpeg.
#pragma once

#include "base/error.h"
#include "settings/values.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace limn {

struct VideoSettings {
    double fps = 24;
};

/// Throws Error where no film could be made there: an unknown ending, or no ffmpeg.
void requireVideo(const std::filesystem::path& film);

/// What a film's name can end in, for messages.
std::string videoExtensions();

/// Makes a film of pictures, all of one size, or replaces it: .mp4 (H.264), .webm (VP9, keeps transparency) and .gif.
/// The same pictures make the same film. Throws Error.
void makeVideo(
    std::span<const std::filesystem::path> frames, const std::filesystem::path& film, const VideoSettings& settings);

/// The files of a pattern such as "out/room_####.png" that are there, by their numbers.
std::vector<std::filesystem::path> framesOnDisk(const std::filesystem::path& pattern);

}  // namespace limn
