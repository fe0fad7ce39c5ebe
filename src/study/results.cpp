#include "study/results.h"

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "image/image.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// The template of the page, and Chart.js: put into the program by CMakeLists.txt.
extern "C" {
extern const char limnStudyPage[], limnStudyPageEnd[], limnChart[], limnChartEnd[];
}

namespace limn {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kPictures{"beauty", "beauty_error", "occlusion", "occlusion_error"};

Json jsonOf(const Deviation& deviation) {
    return {{"rmse", deviation.rmse}, {"bias", deviation.bias}, {"p99", deviation.p99}};
}

/// What is set besides the technique, which the group names.
std::string titleOf(const StudyPoint& point) {
    Settings rest = point.settings;
    const bool isOther = rest.erase("ao") > 0;
    rest.erase("ao.filter");
    return isOther && rest.empty() ? "by default" : settingsText(rest);
}

Json jsonOf(const StudyPoint& point) {
    Json json{{"name", point.name}, {"kind", point.kind}, {"knob", point.knob}, {"group", point.group},
        {"title", titleOf(point)}, {"settings", point.settings}, {"lines", point.lines},
        {"milliseconds", point.milliseconds}, {"low", point.low}, {"high", point.high}, {"first", point.first},
        {"runs", point.runs}, {"slots", Json::object()}, {"picture", jsonOf(point.picture)}};
    for (const auto& [slot, milliseconds] : point.slots) json["slots"][slot] = milliseconds;
    json["picture"]["ssim"] = point.similarity;
    if (point.occlusion) {
        json["occlusion"] = jsonOf(*point.occlusion);
        json["occlusion"]["inside"] = point.occlusion->inside;
        json["occlusion"]["silhouette"] = point.occlusion->silhouette;
        json["occlusion"]["border"] = point.occlusion->border;
    }
    if (point.split)
        json["split"] = {{"unseen", point.split->unseen}, {"estimator", point.split->estimator},
            {"sampling", point.split->sampling}};
    if (point.geometry) json["geometry"] = {{"rmse", point.geometry->rmse}, {"p99", point.geometry->p99}};
    return json;
}

void read(const Json& json, Deviation& deviation) {
    json.at("rmse").get_to(deviation.rmse);
    json.at("bias").get_to(deviation.bias);
    json.at("p99").get_to(deviation.p99);
}

StudyPoint pointOf(const Json& json) {
    StudyPoint point;
    json.at("name").get_to(point.name);
    json.at("kind").get_to(point.kind);
    json.at("knob").get_to(point.knob);
    json.at("group").get_to(point.group);
    json.at("settings").get_to(point.settings);
    json.at("lines").get_to(point.lines);
    json.at("milliseconds").get_to(point.milliseconds);
    json.at("low").get_to(point.low);
    json.at("high").get_to(point.high);
    json.at("first").get_to(point.first);
    json.at("runs").get_to(point.runs);
    for (const auto& [slot, milliseconds] : json.at("slots").items())
        point.slots.emplace_back(slot, milliseconds.get<double>());
    read(json.at("picture"), point.picture);
    json.at("picture").at("ssim").get_to(point.similarity);
    if (json.contains("occlusion")) {
        read(json.at("occlusion"), point.occlusion.emplace());
        json.at("occlusion").at("inside").get_to(point.occlusion->inside);
        json.at("occlusion").at("silhouette").get_to(point.occlusion->silhouette);
        json.at("occlusion").at("border").get_to(point.occlusion->border);
    }
    if (json.contains("split"))
        point.split = {
            json.at("split").at("unseen"), json.at("split").at("estimator"), json.at("split").at("sampling")};
    if (json.contains("geometry")) point.geometry = {json.at("geometry").at("rmse"), json.at("geometry").at("p99")};
    return point;
}

Json jsonOf(const FrontFit& fit) {
    return {{"factor", fit.factor}, {"exponent", fit.exponent}, {"spread", fit.spread}, {"points", fit.points}};
}

Json jsonOf(const SweepReport& report) {
    Json json{{"version", kFormatVersion}, {"config", report.config}, {"scene", report.scene},
        {"device", report.device}, {"identity", report.identity}, {"size", {report.size.x, report.size.y}},
        {"shots", report.shots}, {"notes", report.notes}, {"fronts", Json::object()}, {"points", Json::array()}};
    if (report.truthError) json["truth_error"] = *report.truthError;
    for (const bool byOcclusion : {true, false}) {
        if (byOcclusion && !report.hasOcclusion()) continue;
        const auto front = paretoFront(report.points, byOcclusion);
        Json names = Json::array();
        for (const auto i : front) names.push_back(report.points[i].name);
        json["fronts"][byOcclusion ? "occlusion" : "picture"] = {
            {"points", names}, {"fit", jsonOf(fitFront(report.points, front, byOcclusion))}};
    }
    for (const auto& point : report.points) json["points"].push_back(jsonOf(point));
    for (const auto& point : report.others) json["points"].push_back(jsonOf(point));
    return json;
}

std::filesystem::path pictureFile(const std::filesystem::path& folder, const StudyPoint& point, const char* picture) {
    return folder / "pictures" / fmt::format("{}_{}.jpg", point.name, picture);
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[k])) : 0u;
        };
        const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (unsigned k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

/// The pictures of all points as data addresses.
Json imagesOf(const std::filesystem::path& folder, const SweepReport& report) {
    Json images = Json::object();
    for (const auto& point : report.points)
        for (const char* picture : kPictures) {
            const auto file = pictureFile(folder, point, picture);
            if (fileExists(file))
                images[point.name][picture] = "data:image/jpeg;base64," + base64(MappedFile(file).text());
        }
    for (const auto& [picture, file] :
        {std::pair("beauty", "truth.png"), std::pair("occlusion", "truth_occlusion.png")})
        if (fileExists(folder / "pictures" / file))
            images["truth"][picture] = "data:image/png;base64," + base64(MappedFile(folder / "pictures" / file).text());
    return images;
}

std::string csvOf(const SweepReport& report) {
    const auto quoted = [](std::string text) {
        for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
        return '"' + text + '"';
    };
    std::string csv =
        "technique,settings,kind,milliseconds,low,high,runs,first,picture_rmse,picture_bias,picture_p99,picture_ssim,"
        "occlusion_rmse,occlusion_bias,occlusion_p99,inside,silhouette,border,unseen,estimator,sampling,geometry_rmse,"
        "geometry_p99\n";
    for (const auto& p : report.points) {
        csv += fmt::format("{},{},{},{:.4f},{:.4f},{:.4f},{},{:.2f},{:.6f},{:.6f},{:.6f},{:.6f}", quoted(p.group),
            quoted(settingsText(p.settings)), p.kind, p.milliseconds, p.low, p.high, p.runs, p.first, p.picture.rmse,
            p.picture.bias, p.picture.p99, p.similarity);
        const auto add = [&](bool present, std::initializer_list<double> values) {
            for (const double value : values) csv += present ? fmt::format(",{:.6f}", value) : ",";
        };
        const OcclusionError o = p.occlusion.value_or(OcclusionError());
        add(p.occlusion.has_value(), {o.rmse, o.bias, o.p99, o.inside, o.silhouette, o.border});
        const ErrorSplit s = p.split.value_or(ErrorSplit());
        add(p.split.has_value(), {s.unseen, s.estimator, s.sampling});
        const GeometryError g = p.geometry.value_or(GeometryError());
        add(p.geometry.has_value(), {g.rmse, g.p99});
        csv += '\n';
    }
    return csv;
}

void replace(std::string& text, std::string_view what, std::string_view by) {
    const auto at = text.find(what);
    if (at != std::string::npos) text.replace(at, what.size(), by);
}

/// JSON within a page: nothing in it may look like an end of the script.
std::string withinScript(std::string json) {
    for (std::size_t i = 0; (i = json.find('<', i)) != std::string::npos; i += 6) json.replace(i, 1, "\\u003c");
    return json;
}

}  // namespace

void writePictures(const std::filesystem::path& folder, const StudyPoint& point, const PointPictures& pictures) {
    EncodeOptions options;
    options.quality = 85;
    const Image* images[] = {&pictures.beauty, &pictures.beautyError, &pictures.occlusion, &pictures.occlusionError};
    for (std::size_t i = 0; i < kPictures.size(); ++i) {
        if (images[i]->pixels.empty()) continue;
        Layer layer{"beauty", {"R", "G", "B"}, i == 0, false, *images[i]};
        if (layer.image.channels == 1) layer.channels = {"Y"};
        if (layer.image.channels == 4) layer.channels = {"R", "G", "B", "A"};
        const auto file = pictureFile(folder, point, kPictures[i]);
        replaceFile(file, encodeImage(*imageFormat(file), {&layer, 1}, {}, options));
    }
}

void writeTruth(const std::filesystem::path& folder, const Image& picture, const Image& occlusion) {
    const auto write = [&](const char* name, const Image& image) {
        if (image.pixels.empty()) return;
        const auto file = folder / "pictures" / name;
        const Layer layer{"truth",
            image.channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"}, false, false,
            image};
        replaceFile(file, encodeImage(*imageFormat(file), {&layer, 1}, {}, {}));
    };
    write("truth.png", picture);
    write("truth_occlusion.png", occlusion);
}

void writeFigures(const std::filesystem::path& folder, const SweepReport& report) {
    replaceFile(folder / "study.json", jsonOf(report).dump(1) + "\n");
}

void readFigures(const std::filesystem::path& folder, const std::string& identity, SweepHooks& hooks) {
    const auto file = folder / "study.json";
    if (!fileExists(file)) return;
    try {
        const Json json = Json::parse(MappedFile(file).text());
        if (json.at("identity") != identity) return log::info("{}: of another study; begun anew", file.string());
        std::vector<StudyPoint> points;
        for (const auto& point : json.at("points")) points.push_back(pointOf(point));
        if (json.contains("truth_error")) hooks.knownTruthError = json.at("truth_error").get<double>();
        hooks.known = std::move(points);
        log::info("{}: goes on after {} settings", file.string(), hooks.known.size());
    } catch (const Json::exception& error) {
        log::warning("{}: cannot be read ({}); begun anew", file.string(), error.what());
    }
}

void writeResults(const std::filesystem::path& folder, const SweepReport& report) {
    writeFigures(folder, report);
    replaceFile(folder / "study.csv", csvOf(report));
    replaceFile(folder / "front.svg", frontSvg(report));
    Json data = jsonOf(report);
    data["images"] = imagesOf(folder, report);
    std::string page(limnStudyPage, limnStudyPageEnd);
    replace(page, "@CHART@", std::string_view(limnChart, limnChartEnd));
    replace(page, "@DATA@", withinScript(data.dump()));
    replaceFile(folder / "index.html", page);
}

}  // namespace limn
