// limn plan: shows the passes that would run, and why others were culled. limn check: validates everything without
// drawing.

#include "base/log.h"
#include "cli/commands.h"
#include "image/image.h"
#include "job/frames.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

namespace limn::cli {
namespace {

struct PlanOptions {
    std::string config, format = "text";
    ConfigOverrides overrides;
    std::optional<int> frame;
    std::string frames;
    bool measure = false;
    SessionOptions session;
};

ExitCode runPlan(const PlanOptions& options) {
    const RenderConfig config = readRenderConfig(options.config, options.overrides);
    Session session(options.session);
    if (!options.frames.empty()) {
        const LoadedScene& loaded = session.load(config);
        const std::vector<int> frames = options.frames == "all" ? framesOf(config, "", loaded.scene.frames)
                                                                : framesOf(config, options.frames, loaded.scene.frames);
        const auto changes = compareFrames(config, loaded, frames);
        fmt::print("{}", options.format == "json" ? frameChangesJson(changes) : frameChangesText(changes));
        return ExitCode::done;
    }
    const int frame = options.frame.value_or(session.load(config).scene.firstFrame());
    std::vector<double> milliseconds;
    if (options.measure) {
        RenderOptions measured;
        measured.measure = true;
        session.draw(config, frame);  // warms up: programs, textures
        session.draw(config, frame, measured);
        for (const auto& pass : session.renderer().passTimes()) milliseconds.push_back(pass.milliseconds);
    }
    PlanReport plan = session.plan(config, frame);
    if (options.measure) plan.facts.emplace_back("times", "GPU milliseconds of all samples of one frame");
    const auto format = options.format == "json" ? PlanFormat::json
        : options.format == "dot"                ? PlanFormat::dot
                                                 : PlanFormat::text;
    fmt::print("{}", explain(plan.pipeline.graph, plan.pipeline.plan, format, plan.facts, milliseconds));
    return ExitCode::done;
}

ExitCode runCheck(const std::vector<std::string>& configs, const ConfigOverrides& overrides) {
    ErrorCollector errors;
    for (const auto& path : configs)
        errors.run([&] {
            const RenderConfig config = readRenderConfig(path, overrides);
            Session session;
            const LoadedScene& loaded = session.load(config);
            const int first = loaded.scene.firstFrame();
            const auto& meshes = loaded.scene.meshes;
            if (std::any_of(meshes.begin(), meshes.end(), [](const auto& mesh) { return mesh.perFrame; }))
                for (std::int64_t frame = first; loaded.scene.frames && frame <= loaded.scene.frames->last; ++frame)
                    static_cast<void>(loaded.meshes->at(static_cast<int>(frame)));
            static_cast<void>(session.plan(config, first));
            ErrorCollector damaged;
            const ImageKeys fromMeshes = loaded.meshes->imageKeys();
            // A config that passes must draw: images that cannot be decoded would end the render.
            for (const auto* images : {&loaded.images, &fromMeshes})
                for (const auto& image : *images) damaged.run([&] { static_cast<void>(readImage(image.first)); });
            damaged.throwIfAny();
            log::info("{}: fine", path);
        });
    errors.throwIfAny();
    return ExitCode::done;
}

}  // namespace

void addPlan(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<PlanOptions>();
    auto* command = app.add_subcommand("plan", "Show what would run, what was culled and why");
    command->add_option("CONFIG", options->config, "Config file, or an OBJ file")->required();
    command->add_option("--set", options->overrides.settings, "Change a setting: ao.radius=0.4")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_option("--camera", options->overrides.camera, "Camera of the scene to draw from")->type_name("NAME");
    command
        ->add_option(
            "--subdivide", options->overrides.meshFile.subdivide, "Take OBJ files as subdivision cages of this level")
        ->type_name("N")
        ->check(CLI::Range(0, 10));
    addUpOption(*command, options->overrides.meshFile);
    command->add_option("--frame", options->frame, "Frame to plan; the first declared one without it")->type_name("N");
    command
        ->add_option("--frames", options->frames,
            "What each of these frames reads, makes and draws, and why: 1-100, or all that the scene declares")
        ->type_name("SPEC|all");
    command->add_option("--format", options->format, "text, json or dot")
        ->check(CLI::IsMember({"text", "json", "dot"}));
    command->add_flag("--measure", options->measure, "Draw a frame and add the milliseconds of each pass");
    addDeviceFlags(*command, options->session);
    command->callback([options, &chosen] { chosen = [options] { return runPlan(*options); }; });
}

void addCheck(CLI::App& app, Chosen& chosen) {
    auto configs = std::make_shared<std::vector<std::string>>();
    auto overrides = std::make_shared<ConfigOverrides>();
    auto* command =
        app.add_subcommand("check", "Validate configs, scenes and meshes without drawing; all problems at once");
    command->add_option("CONFIG", *configs, "Config files")->required();
    command->add_option("--set", overrides->settings, "Change a setting")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->callback([=, &chosen] { chosen = [=] { return runCheck(*configs, *overrides); }; });
}

}  // namespace limn::cli
