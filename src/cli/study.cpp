// limn study: accuracy against time.

#include "study/study.h"
#include "base/file.h"
#include "cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace limn::cli {
namespace {

struct StudyOptions {
    std::string file, output;
    SessionOptions session;
};

/// The error times four: grey where equal, darker where the picture is too dark, lighter where it is too light.
Image errorPicture(const Image& picture, const Image& truth) {
    Image error = picture;
    for (std::size_t i = 0; i < error.pixels.size(); ++i)
        error.pixels[i] = std::clamp(0.5f + 4 * (picture.pixels[i] - truth.pixels[i]), 0.0f, 1.0f);
    return error;
}

ExitCode runStudyCommand(const StudyOptions& options) {
    const Study study = readStudy(options.file);
    const std::filesystem::path folder = options.output;
    if (!options.output.empty()) {
        std::error_code failed;
        std::filesystem::create_directories(folder, failed);
        if (failed)
            throw Error(ExitCode::cannotCreate, {options.output}, "cannot make this folder: " + failed.message(),
                "choose another --output");
    }
    const auto save = [&](std::string name, const Image& image) {
        std::replace(name.begin(), name.end(), ' ', '_');
        const Layer layer{"ambient_occlusion", {"Y"}, false, false, image};
        replaceFile(folder / (name + ".png"), encodeImage(*imageFormat("study.png"), {&layer, 1}, {}, {}));
    };
    Session session(options.session);
    fmt::print("{}×{} pixels, truth by {} rays per pixel; times: fastest of {}, {}\n\n", study.settings.size.x,
        study.settings.size.y, study.settings.rays, study.settings.repeat,
        session.renderer().device().report().renderer);
    fmt::print("{:<10} {:<7} {:<28} {:>7} {:>8} {:>7} {:>10} {:>9} {:>9} {:>9} {:>8}  {}\n", "place", "camera",
        "method", "RMSE", "bias", "P99", "off shell", "ms", "µs/pixel", "transfer", "tree", "settings");
    std::string csv =
        "place,camera,method,rmse,bias,p99,shell_rmse,milliseconds,microseconds_per_pixel,transfer_milliseconds,tree_"
        "milliseconds,settings\n";
    runStudy(session, study, [&](const StudyRow& row) {
        fmt::print("{:<10} {:<7} {:<28} {:7.4f} {:+8.4f} {:7.4f} {:10.4f} {:9.2f} {:9.3f} {:9.2f} {:8.2f}  {}\n",
            row.place, row.camera, row.method, row.truth.rmse, row.truth.bias, row.truth.p99, row.shellRmse,
            row.milliseconds, row.microsecondsPerPixel, row.transferMilliseconds, row.treeMilliseconds, row.settings);
        std::fflush(stdout);
        if (options.output.empty()) return;
        const std::string shot = fmt::format("{}_{}", row.place, row.camera);
        save(shot + "_truth", row.truthPicture);
        save(shot + "_shell", row.shellPicture);
        save(shot + "_" + row.method, row.picture);
        save(shot + "_" + row.method + "_error", errorPicture(row.picture, row.truthPicture));
        save(shot + "_" + row.method + "_off_shell", errorPicture(row.picture, row.shellPicture));
        csv += fmt::format("{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.5f},{:.4f},{:.4f},{}\n", row.place,
            row.camera, row.method, row.truth.rmse, row.truth.bias, row.truth.p99, row.shellRmse, row.milliseconds,
            row.microsecondsPerPixel, row.transferMilliseconds, row.treeMilliseconds, row.settings);
    });
    if (!options.output.empty()) replaceFile(folder / "study.csv", csv);
    return ExitCode::done;
}

}  // namespace

void addStudy(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<StudyOptions>();
    auto* command = app.add_subcommand("study", "Measure what accuracy costs in time, against the ray-traced truth");
    command->add_option("FILE", options->file, "Study file: places and methods")->required();
    command->add_option("--output", options->output, "Folder for study.csv and the pictures")->type_name("DIR");
    addDeviceFlags(*command, options->session);
    command->callback([options, &chosen] { chosen = [options] { return runStudyCommand(*options); }; });
}

}  // namespace limn::cli
