#include "study/study.h"

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace limn {
namespace {

constexpr Field kSettings[] = {
    field<&StudySettings::size>(
        "size", {.unit = "pixels", .min = 1, .max = 16384, .keyable = false}, "Of every picture."),
    field<&StudySettings::rays>("rays", {.min = 1, .max = 65536, .keyable = false}, "Of the truth, per pixel."),
    field<&StudySettings::repeat>(
        "repeat", {.min = 1, .max = 100, .keyable = false}, "The fastest of so many runs counts."),
};
constexpr Field kPlace[] = {
    field<&StudyPlace::name>("name", {.required = true}, "As the table calls it."),
    field<&StudyPlace::scene>("scene", {.required = true}, "Scene file or OBJ."),
    field<&StudyPlace::radius>(
        "radius", {.unit = "scene units", .min = 1e-9, .keyable = false}, "Of ambient occlusion."),
};
constexpr Field kMethod[] = {
    field<&StudyMethod::name>("name", {.required = true}, "As the table calls it."),
    field<&StudyMethod::milliseconds>(
        "milliseconds", {.min = 0, .keyable = false}, "Settings that take longer do not count; 0 = no limit."),
};

class StudyReader {
public:
    Study read(const std::filesystem::path& path) {
        const Node document = readDocument(path);
        Study study;
        readVersion(document, "the study", errors_);
        for (const auto& [key, node] : document.table()) {
            if (key == "version") continue;
            if (key == "image")
                readFields(node, kSettings, &study.settings, nullptr, "[image]", errors_);
            else if (key == "place")
                forEach(node, [&](const Node& place) { study.places.push_back(readPlace(place)); });
            else if (key == "method")
                forEach(node, [&](const Node& method) { study.methods.push_back(readMethod(method)); });
            else
                fail(node, fmt::format("a study has no '{}'", key), "it can be image, place or method");
        }
        if (study.places.empty()) fail(document, "the study has no [[place]]", "add one, with name, scene and score");
        if (study.methods.empty()) fail(document, "the study has no [[method]]", "add one, with name and ao");
        errors_.throwIfAny();
        return study;
    }

private:
    void fail(const Node& node, std::string problem, std::string remedy) {
        errors_.add({ExitCode::usage, node.where, std::move(problem), std::move(remedy)});
    }

    void forEach(const Node& node, const auto& read) {
        if (!node.isArray()) return fail(node, "this must be a list of tables", "write it in double brackets");
        for (const auto& entry : node.array()) read(entry);
    }

    StudyPlace readPlace(const Node& node) {
        StudyPlace place;
        static constexpr std::string_view alsoKnown[] = {"tune", "score"};
        readFields(node, kPlace, &place, nullptr, "[[place]]", errors_, alsoKnown);
        if (const Node* scene = node.find("scene"); scene && scene->text()) {
            place.scene = pathIn(*scene).string();
            if (!fileExists(place.scene))
                errors_.add(
                    {ExitCode::missingInput, scene->where, fmt::format("the scene '{}' does not exist", place.scene),
                        "paths are relative to the file that names them"});
        }
        const auto names = [&](const char* key, std::vector<std::string>& into) {
            const Node* list = node.find(key);
            if (!list) return;
            if (!list->isArray()) return fail(*list, fmt::format("'{}' must be a list of cameras", key), "");
            for (const auto& entry : list->array())
                if (entry.text())
                    into.push_back(*entry.text());
                else
                    fail(entry, "a camera's name must be text", "");
        };
        names("tune", place.tune);
        names("score", place.score);
        if (place.score.empty()) fail(node, "a [[place]] needs 'score', a list of cameras", "");
        return place;
    }

    StudyMethod readMethod(const Node& node) {
        StudyMethod method;
        static constexpr std::string_view alsoKnown[] = {"ao", "tune"};
        readFields(node, kMethod, &method, nullptr, "[[method]]", errors_, alsoKnown);
        if (const Node* ao = node.find("ao"); ao && ao->isTable()) {
            method.ao = *ao;
            static_cast<void>(readChoices(documentOf(*ao), errors_));
        } else {
            fail(node, "a [[method]] needs 'ao', a table as in a render config", "");
        }
        if (const Node* tune = node.find("tune")) readAxes(*tune, method);
        return method;
    }

    /// A config of nothing but this table.
    static Node documentOf(const Node& ao) { return Node{ao.where, Node::Table{{"ao", ao}}, {}}; }

    void readAxes(const Node& tune, StudyMethod& method) {
        if (!tune.isTable()) return fail(tune, "'tune' must be a table of lists", "");
        std::vector<const Node*> places;  // of each axis' values
        for (const auto& [key, values] : tune.table()) {
            StudyAxis axis{key, {}};
            if (!values.isArray() || values.array().empty())
                fail(values, fmt::format("'{}' must be a list of values", key), "");
            else
                for (const auto& value : values.array())
                    axis.values.push_back(
                        value.text() ? *value.text() : numberText(static_cast<float>(value.number())));
            method.axes.push_back(std::move(axis));
            places.push_back(&values);
        }
        if (!errors_.empty()) return;
        for (std::size_t a = 0; a < method.axes.size(); ++a)
            for (std::size_t v = 0; v < method.axes[a].values.size(); ++v)
                checkValue(method, a, v, places[a]->array()[v]);
    }

    /// A config with this value, and the first of every other axis, must be readable.
    void checkValue(const StudyMethod& method, std::size_t axis, std::size_t value, const Node& at) {
        ErrorCollector found;
        found.run([&] {
            Node document = documentOf(method.ao);
            for (std::size_t a = 0; a < method.axes.size(); ++a)
                applySetting(document,
                    fmt::format("ao.{}={}", method.axes[a].key, method.axes[a].values[a == axis ? value : 0]));
            static_cast<void>(readChoices(document, found));
        });
        for (const auto& error : found.list()) errors_.add({error.code, at.where, error.problem, error.remedy});
    }

    ErrorCollector errors_;
};

/// The data of one camera.
struct Shot {
    std::string camera;
    std::vector<float> truth, shell;  ///< visibility; negative on the background
};

/// Runs the methods at one place.
class PlaceRunner {
public:
    PlaceRunner(Session& session, const StudySettings& settings, const StudyPlace& place)
        : session_(session), settings_(settings), place_(place) {}

    StudyRow score(const StudyMethod& method, const std::vector<std::string>& settings, const std::string& camera) {
        const Shot& known = shot(camera);
        StudyRow row = draw(method, settings, camera);
        row.truth = compare(picture_, known.truth);
        row.shellRmse = compare(picture_, known.shell).rmse;
        const auto image = [&](std::vector<float> values) {
            for (float& v : values) v = v < 0 ? 1 : v;
            return Image{settings_.size.x, settings_.size.y, 1, std::move(values)};
        };
        row.picture = image(picture_);
        row.truthPicture = image(known.truth);
        row.shellPicture = image(known.shell);
        return row;
    }

    /// Finds the settings with the least error over the tuning cameras: one axis after the other, until nothing
    /// improves.
    std::vector<std::string> tune(const StudyMethod& method) {
        std::vector<std::size_t> at(method.axes.size(), 0);
        const auto settings = [&] {
            std::vector<std::string> chosen;
            for (std::size_t a = 0; a < at.size(); ++a)
                chosen.push_back(fmt::format("ao.{}={}", method.axes[a].key, method.axes[a].values[at[a]]));
            return chosen;
        };
        if (place_.tune.empty() || method.axes.empty()) return settings();
        std::map<std::vector<std::size_t>, double> known;
        const auto cost = [&] {
            if (const auto it = known.find(at); it != known.end()) return it->second;
            double squares = 0, milliseconds = 0;
            for (const auto& camera : place_.tune) {
                const StudyRow row = score(method, settings(), camera);
                squares += row.truth.rmse * row.truth.rmse;
                milliseconds = std::max(milliseconds, row.milliseconds);
            }
            // Too slow is worse than any error; slower is worse still.
            const double value = method.milliseconds > 0 && milliseconds > method.milliseconds
                ? 1e3 + milliseconds
                : std::sqrt(squares / static_cast<double>(place_.tune.size()));
            return known[at] = value;
        };
        double best = cost();
        for (bool improved = true; improved;) {
            improved = false;
            for (std::size_t a = 0; a < at.size(); ++a) {
                const std::size_t was = at[a];
                std::size_t choice = was;
                for (std::size_t v = 0; v < method.axes[a].values.size(); ++v) {
                    at[a] = v;
                    if (const double value = cost(); value < best) {
                        best = value;
                        choice = v;
                        improved = true;
                    }
                }
                at[a] = choice;
            }
        }
        return settings();
    }

private:
    RenderConfig config(
        const std::string& camera, Node ao, const std::vector<std::string>& settings, std::string_view aovs) const {
        Node document = parseDocument(
            fmt::format("shading = 'flat'\n[image]\nsize = [{}, {}]\nsamples = 1\n[output]\naovs = [{}]\n",
                settings_.size.x, settings_.size.y, aovs),
            "study");
        auto& table = std::get<Node::Table>(document.value);
        table.emplace_back("scene", Node{{}, place_.scene, {}});
        if (!camera.empty()) table.emplace_back("camera", Node{{}, camera, {}});
        if (ao.isTable() && !ao.table().empty()) {
            const bool hasRadius = [&] {
                const Node* technique = ao.find("technique");
                const Technique* known =
                    technique && technique->text() ? findTechnique("ao", *technique->text()) : nullptr;
                return known && findField(known->schema, "radius");
            }();
            if (hasRadius && !ao.find("radius"))
                std::get<Node::Table>(ao.value).emplace_back("radius",
                    place_.radius.relative ? Node{{}, fmt::format("{}%", place_.radius.amount * 100), {}}
                                           : Node{{}, place_.radius.amount, {}});
            table.emplace_back("ao", std::move(ao));
        }
        for (const auto& setting : settings) applySetting(document, setting);
        return parseRenderConfig(std::move(document), "study");
    }

    int first(const RenderConfig& config) { return session_.load(config).scene.firstFrame(); }

    const Shot& shot(const std::string& camera) {
        if (const auto it = shots_.find(camera); it != shots_.end()) return it->second;
        log::info("{} {}: the truth, {} rays per pixel", place_.name, camera, settings_.rays);
        Shot shot{camera, {}, {}};
        const Node rays = parseDocument(fmt::format("technique = 'ray_traced'\nrays = {}\n", settings_.rays), "study");
        const RenderConfig truth = config(camera, rays, {}, "'ambient_occlusion', 'depth'");
        const RenderedFrame frame = session_.draw(truth, first(truth));
        shot.truth = frame.layers[0].image.pixels;
        const auto& depth = frame.layers[1].image.pixels;
        for (std::size_t i = 0; i < shot.truth.size(); ++i)
            if (!std::isfinite(depth[i])) shot.truth[i] = -1;

        // Traces the same rays against the depth buffer's shell, guard band included.
        RenderOptions wide;
        wide.guard =
            static_cast<int>(std::ceil(ImageSettings{}.guard * std::max(settings_.size.x, settings_.size.y))) / 2 * 2;
        const RenderConfig surfaces = config(camera, Node{}, {}, "'depth', 'normal_geometric'");
        const RenderedFrame seen = session_.draw(surfaces, first(surfaces), wide);
        shot.shell =
            shellVisibility(seen, sceneInfo(session_.load(surfaces)), place_.radius, settings_.rays, settings_.size);
        for (std::size_t i = 0; i < shot.shell.size(); ++i)
            if (shot.truth[i] < 0) shot.shell[i] = -1;
        return shots_[camera] = std::move(shot);
    }

    StudyRow draw(const StudyMethod& method, const std::vector<std::string>& settings, const std::string& camera) {
        StudyRow row;
        row.place = place_.name;
        row.camera = camera;
        row.method = method.name;
        row.milliseconds = 1e30;
        for (const auto& setting : settings) row.settings += (row.settings.empty() ? "" : " ") + setting.substr(3);
        const RenderConfig wanted = config(camera, method.ao, settings, "'ambient_occlusion'");
        RenderOptions options;
        options.measure = true;
        for (int run = 0; run < settings_.repeat; ++run) {
            RenderedFrame frame = session_.draw(wanted, first(wanted), options);
            for (const auto& part : frame.times)
                if (part.name == "of which ray tracing tree") tree_ = part.milliseconds;
            double milliseconds = 0;
            for (const auto& pass : session_.renderer().passTimes())
                if (pass.slot == "ao" || pass.slot == "filter") milliseconds += pass.milliseconds;
            milliseconds -= session_.renderer().transferMilliseconds();
            if (milliseconds < row.milliseconds) {
                row.milliseconds = milliseconds;
                row.transferMilliseconds = session_.renderer().transferMilliseconds();
            }
            picture_ = std::move(frame.layers[0].image.pixels);
        }
        if (const Node* technique = method.ao.find("technique");
            technique && technique->text() && *technique->text() == "ray_traced")
            row.treeMilliseconds = tree_;
        row.microsecondsPerPixel = row.milliseconds * 1e3 / (static_cast<double>(settings_.size.x) * settings_.size.y);
        return row;
    }

    Session& session_;
    const StudySettings& settings_;
    const StudyPlace& place_;
    std::map<std::string, Shot> shots_;
    std::vector<float> picture_;  ///< of the last draw()
    double tree_ = 0;
};

}  // namespace

Study readStudy(const std::filesystem::path& path) { return StudyReader().read(path); }

void runStudy(Session& session, const Study& study, const std::function<void(const StudyRow&)>& report) {
    for (const auto& place : study.places) {
        PlaceRunner runner(session, study.settings, place);
        for (const auto& method : study.methods) {
            const auto settings = runner.tune(method);
            for (const auto& camera : place.score) report(runner.score(method, settings, camera));
        }
    }
}

}  // namespace limn
