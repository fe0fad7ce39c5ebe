#include "job/video.h"

#include "base/file.h"
#include "base/log.h"
#include "base/process.h"
#include "base/text.h"
#include "image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

namespace limn {
namespace {

constexpr const char* kProgram = "ffmpeg";

/// A kind of film: its ending and what ffmpeg is told about it.
struct Kind {
    const char* extension;
    bool keepsAlpha;
    std::vector<std::string> options;
};

/// Colours are what display-encoded pictures mean: Rec. 709 primaries, its matrix, limited range, and tags that say so.
/// The quality is constant; at these values lines keep their edges.
const std::vector<Kind>& kinds() {
    const std::string toRec709 = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int";
    const std::vector<std::string> tags{
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"};
    static const std::vector<Kind> list = [&] {
        std::vector<Kind> all{{".mp4", false,
                                  {"-vf", toRec709, "-c:v", "libx264", "-preset", "medium", "-crf", "16", "-pix_fmt",
                                      "yuv420p", "-movflags", "+faststart", "-f", "mp4"}},
            {".webm", true,
                {"-vf", toRec709, "-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-row-mt", "1", "-auto-alt-ref", "0",
                    "-f", "webm"}},
            {".gif", false,
                {"-filter_complex",
                    "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=sierra2_4a:diff_mode="
                    "rectangle",
                    "-loop", "0", "-f", "gif"}}};
        for (auto& kind : all)
            if (kind.extension != std::string_view(".gif"))
                kind.options.insert(kind.options.end() - 2, tags.begin(), tags.end());
        return all;
    }();
    return list;
}

const Kind* kindOf(const std::filesystem::path& film) {
    const std::string extension = lowerCase(film.extension().string());
    for (const auto& kind : kinds())
        if (kind.extension == extension) return &kind;
    return nullptr;
}

/// A picture as ffmpeg takes it: 8 bits, display-encoded, red, green, blue and, where the film keeps it, alpha. Sides
/// are made even by repeating the last row and column, since colours are stored for two by two pixels.
struct RawFrame {
    glm::ivec2 size{0};
    bool hasAlpha = false;
    std::vector<std::uint8_t> bytes;
};

RawFrame readFrame(const std::filesystem::path& path, bool keepsAlpha) {
    Layer layer{"beauty", {}, true, false, readImage(path)};
    const Image& image = layer.image;
    RawFrame frame;
    frame.hasAlpha = image.channels == 2 || image.channels == 4;
    const bool writesAlpha = keepsAlpha && frame.hasAlpha;
    frame.size = {(image.width + 1) / 2 * 2, (image.height + 1) / 2 * 2};
    Image out{frame.size.x, frame.size.y, writesAlpha ? 4 : 3, {}};
    out.pixels.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height)
        * static_cast<std::size_t>(out.channels));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const float* pixel = image.at(std::min(x, image.width - 1), std::min(y, image.height - 1));
            const float alpha = frame.hasAlpha ? pixel[image.channels - 1] : 1;
            for (int c = 0; c < 3; ++c)
                out.pixels.push_back(pixel[image.channels >= 3 ? c : 0] * (writesAlpha ? 1 : alpha));
            if (writesAlpha) out.pixels.push_back(alpha);
        }
    layer.image = std::move(out);
    // Unassociated, as the picture's file has it: quantizing must not divide by alpha again.
    if (writesAlpha)
        for (std::size_t i = 0; i < layer.image.pixels.size(); i += 4)
            for (std::size_t c = 0; c < 3; ++c) layer.image.pixels[i + c] *= layer.image.pixels[i + 3];
    frame.bytes = quantize8(layer);
    return frame;
}

/// The last thing that ffmpeg said, on one line.
std::string lastLine(const std::string& said) {
    const auto end = said.find_last_not_of(" \r\n");
    if (end == std::string::npos) return "it said nothing";
    const auto begin = said.find_last_of('\n', end);
    return said.substr(
        begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

}  // namespace

std::string videoExtensions() { return ".mp4, .webm or .gif"; }

void requireVideo(const std::filesystem::path& film) {
    if (!kindOf(film))
        throw Error(ExitCode::usage, {film.string()}, "this is no film", "end the path in " + videoExtensions());
    if (!findProgram(kProgram))
        throw Error(ExitCode::missingInput, {film.string()}, "films are made by ffmpeg, which is not there",
            "install it (its package in Debian: ffmpeg), or leave the film out");
}

void makeVideo(
    std::span<const std::filesystem::path> frames, const std::filesystem::path& film, const VideoSettings& settings) {
    requireVideo(film);
    if (frames.empty()) throw Error(ExitCode::missingInput, {film.string()}, "there are no frames for the film");
    const Kind& kind = *kindOf(film);
    const RawFrame first = readFrame(frames.front(), kind.keepsAlpha);
    if (first.hasAlpha && !kind.keepsAlpha)
        log::warning("{}: {} keeps no transparency: the background is black; end the path in .webm", film.string(),
            kind.extension);
    ReservedFile reserved(film);
    std::vector<std::string> command{kProgram, "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo",
        "-pixel_format", first.hasAlpha && kind.keepsAlpha ? "rgba" : "rgb24", "-video_size",
        fmt::format("{}x{}", first.size.x, first.size.y), "-framerate", fmt::format("{}", settings.fps), "-i",
        "pipe:0"};
    if (kind.keepsAlpha) command.insert(command.end(), {"-pix_fmt", first.hasAlpha ? "yuva420p" : "yuv420p"});
    command.insert(command.end(), kind.options.begin(), kind.options.end());
    command.insert(command.end() - 2, {"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"});
    command.push_back("file:" + reserved.temporary().string());
    ChildProcess encoder(command);
    bool isWhole = true;
    for (const auto& path : frames) {
        const RawFrame frame = path == frames.front() ? first : readFrame(path, kind.keepsAlpha);
        if (frame.size != first.size || frame.hasAlpha != first.hasAlpha)
            throw Error(ExitCode::badData, {path.string()},
                fmt::format("is not like the film's first frame: {}×{} pixels", frame.size.x, frame.size.y),
                "draw all frames by the same config");
        if (!(isWhole = encoder.write(std::as_bytes(std::span(frame.bytes))))) break;
    }
    const auto [exitCode, said] = encoder.finish();
    if (exitCode != 0 || !isWhole)
        throw Error(ExitCode::ioError, {film.string()}, fmt::format("ffmpeg failed ({})", lastLine(said)),
            "free some space, or try another kind of film; the frames are unharmed");
    reserved.commit();
}

std::vector<std::filesystem::path> framesOnDisk(const std::filesystem::path& pattern) {
    const std::string name = pattern.filename().string();
    const auto first = name.find('#');
    if (first == std::string::npos)
        throw Error(ExitCode::usage, {pattern.string()}, "is no pattern of frames",
            "put #### where the frame's number is: out/room_####.png");
    const auto last = name.find_first_not_of('#', first);
    const std::string before = name.substr(0, first), after = last == std::string::npos ? "" : name.substr(last);
    const auto folder = pattern.has_parent_path() ? pattern.parent_path() : std::filesystem::path(".");
    std::map<int, std::filesystem::path> found;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
        const std::string file = entry.path().filename().string();
        if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
            continue;
        int number = 0;
        const char* const begin = file.data() + before.size();
        const char* const end = file.data() + file.size() - after.size();
        const auto [at, status] = std::from_chars(begin, end, number);
        // Only as it would be written: "7" is no frame of "####".
        if (status == std::errc() && at == end && framePath(pattern, number).filename() == file)
            found[number] = entry.path();
    }
    std::vector<std::filesystem::path> files;
    for (auto& [number, path] : found) files.push_back(std::move(path));
    if (files.empty())
        throw Error(ExitCode::missingInput, {pattern.string()}, "there are no such frames", "check the path");
    return files;
}

}  // namespace limn
