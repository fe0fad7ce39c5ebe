// limn study: accuracy against time.

#include "study/study.h"
#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "settings/document.h"
#include "study/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace limn::cli {
namespace {

struct StudyOptions {
    std::string file, output;
    std::vector<std::string> settings;
    std::optional<double> budget;
    SessionOptions session;
};

/// The error times four: grey where equal, darker where the picture is too dark, lighter where it is too light.
Image errorPicture(const Image& picture, const Image& truth) {
    Image error = picture;
    for (std::size_t i = 0; i < error.pixels.size(); ++i)
        error.pixels[i] = std::clamp(0.5f + 4 * (picture.pixels[i] - truth.pixels[i]), 0.0f, 1.0f);
    return error;
}

/// Places and methods of ambient occlusion, as a table.
ExitCode runTable(const StudyOptions& options) {
    const Study study = readStudy(options.file);
    const std::filesystem::path folder = options.output;
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

void printFront(const SweepReport& report, bool byOcclusion) {
    const auto front = paretoFront(report.points, byOcclusion);
    fmt::print("\n{}: settings that no other beats\n{:>9} {:>8} {:>8} {:>8}  {}\n",
        byOcclusion ? "ambient occlusion" : "picture", "ms", "RMSE", "bias", "P99", "settings");
    for (const auto i : front) {
        const StudyPoint& point = report.points[i];
        const Deviation& off = byOcclusion ? *point.occlusion : point.picture;
        fmt::print("{:9.1f} {:8.4f} {:+8.4f} {:8.4f}  {}\n", point.milliseconds, off.rmse, off.bias, off.p99,
            presentable(settingsText(point.settings)));
    }
    const FrontFit fit = fitFront(report.points, front, byOcclusion);
    if (fit.points > 0)
        fmt::print("along it the error is about {:.3g} · seconds^{:.2f}, within a factor of {:.2f}\n",
            fit.factor * std::pow(1000.0, fit.exponent), fit.exponent, std::pow(10.0, fit.spread));
    const StudyPoint* told = nullptr;
    for (const double seconds : {0.1, 0.3, 1.0, 3.0, 10.0}) {
        const StudyPoint* best = nullptr;
        for (const auto i : front)
            if (report.points[i].milliseconds <= 1000 * seconds) best = &report.points[i];
        if (!best || std::exchange(told, best) == best) continue;
        fmt::print("best within {} s: {}, error {:.4f}\n", seconds, presentable(settingsText(best->settings)),
            errorOf(*best, byOcclusion));
    }
}

/// Every knob of a config.
ExitCode runConfig(const StudyOptions& options, Node document) {
    layerSettings(document, options.settings);
    SweepSettings settings = takeSweepSettings(document);
    if (options.budget) settings.seconds = *options.budget;
    Session session(options.session);
    SweepHooks hooks;
    const std::filesystem::path folder = options.output;
    if (!options.output.empty()) {
        requireWritable(folder / "index.html");
        readFigures(folder, sweepIdentity(session, parseRenderConfig(document, options.file), settings), hooks);
        hooks.onPoint = [&](const SweepReport& report, const StudyPoint& point, const PointPictures& pictures) {
            writePictures(folder, point, pictures);
            writeFigures(folder, report);
        };
        hooks.onTruth = [&](const Image& picture, const Image& occlusion) { writeTruth(folder, picture, occlusion); };
    } else {
        hooks.onPoint = [](const auto&, const auto&, const auto&) {};
    }
    const SweepReport report = runSweep(session, std::move(document), options.file, settings, std::move(hooks));
    fmt::print("{}: {} settings at {}×{} pixels, {}; medians of {}\n", options.file, report.points.size(),
        report.size.x, report.size.y, report.device, settings.repeat);
    if (report.truthError) fmt::print("standard error of true ambient occlusion: {:.4f}\n", *report.truthError);
    if (report.hasOcclusion()) printFront(report, true);
    printFront(report, false);
    for (const auto& note : report.notes) log::warning("{}", note);
    if (options.output.empty()) return ExitCode::done;
    writeResults(folder, report);
    log::info("Saved: '{}'", (folder / "index.html").string());
    return ExitCode::done;
}

ExitCode runStudyCommand(const StudyOptions& options) {
    Node document = readConfigDocument(options.file);
    if (!document.find("place") && !document.find("method")) return runConfig(options, std::move(document));
    if (options.budget || !options.settings.empty())
        throw Error(ExitCode::usage, {options.file},
            "is a table of places and methods: --set and --budget go with a config", "leave them out");
    return runTable(options);
}

}  // namespace

void addStudy(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<StudyOptions>();
    auto* command = app.add_subcommand("study", "Measure what accuracy costs in time, against the ray-traced truth");
    command
        ->add_option("CONFIG", options->file,
            "Config, with a [study] table if some things only are to be studied; or a table of places and methods")
        ->required();
    command
        ->add_option("--output", options->output,
            "Folder for the page, the figures and the pictures; a study that "
            "was interrupted there goes on")
        ->type_name("DIR");
    command->add_option("--budget", options->budget, "Seconds to spend, the truth aside; 600 without it")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber);
    command->add_option("--set", options->settings, "Change a setting: image.size=[640,360]")->type_name("KEY=VALUE");
    addDeviceFlags(*command, options->session);
    command->callback([options, &chosen] { chosen = [options] { return runStudyCommand(*options); }; });
}

}  // namespace limn::cli
