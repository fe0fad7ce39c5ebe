// The front as a drawing: error against time, in powers of ten.

#include "study/results.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace limn {
namespace {

constexpr double kWidth = 900, kHeight = 560, kLeft = 80, kRight = 240, kTop = 50, kBottom = 60;
constexpr std::string_view kColors[] = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#9a7b3c", "#8c8c8c"};

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
    return safe;
}

/// One axis in powers of ten.
struct Scale {
    double low = 0, high = 1, from = 0, to = 1;  ///< logarithms, and places on paper
    double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
    void fit(std::vector<double> values) {
        std::erase_if(values, [](double v) { return !(v > 0); });
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        low = values.empty() ? -1 : std::log10(*least) - 0.08;
        high = values.empty() ? 0 : std::log10(*most) + 0.08;
    }
    std::vector<double> ticks() const {
        std::vector<double> all;
        for (int power = static_cast<int>(std::floor(low)); power <= high; ++power)
            for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
                const double value = step * std::pow(10.0, power);
                if (std::log10(value) >= low && std::log10(value) <= high) all.push_back(value);
            }
        return all;
    }
};

std::string axes(const Scale& x, const Scale& y, std::string_view measure) {
    std::string svg;
    for (const double tick : x.ticks())
        svg += fmt::format(
            "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4}</text>\n",
            x.at(tick), kTop, kHeight - kBottom, kHeight - kBottom + 18, numberText(static_cast<float>(tick)));
    for (const double tick : y.ticks())
        svg += fmt::format(
            "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
            "text-anchor=\"end\">{5}</text>\n",
            y.at(tick), kLeft, kWidth - kRight, kLeft - 8, y.at(tick) + 4, numberText(static_cast<float>(tick)));
    return svg
        + fmt::format(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">seconds a frame</text>\n<text "
            "transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            (kLeft + kWidth - kRight) / 2, kHeight - 14, (kTop + kHeight - kBottom) / 2, measure);
}

}  // namespace

std::string frontSvg(const SweepReport& report) {
    const bool byOcclusion = report.hasOcclusion();
    std::vector<double> times, errors;
    std::map<std::string, std::size_t> colors;
    for (const auto& point : report.points) {
        if (byOcclusion && !point.occlusion) continue;
        times.push_back(point.milliseconds / 1000);
        errors.push_back(errorOf(point, byOcclusion));
        colors.try_emplace(point.group.substr(0, point.group.find(',')), colors.size());
    }
    Scale x{0, 1, kLeft, kWidth - kRight}, y{0, 1, kHeight - kBottom, kTop};
    x.fit(times);
    y.fit(errors);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<text "
        "x=\"{2}\" y=\"24\" font-size=\"16\">{3}, {4}×{5} pixels</text>\n",
        kWidth, kHeight, kLeft, escaped(std::filesystem::path(report.config).filename().string()), report.size.x,
        report.size.y);
    svg += axes(x, y, byOcclusion ? "error of ambient occlusion (RMSE)" : "error of the picture (RMSE)");
    for (const auto& point : report.points) {
        const double error = errorOf(point, byOcclusion);
        if ((byOcclusion && !point.occlusion) || !(error > 0)) continue;
        const auto color = colors.at(point.group.substr(0, point.group.find(',')));
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\" fill-opacity=\"0.7\"/>\n",
            x.at(point.milliseconds / 1000), y.at(error), kColors[color % std::size(kColors)]);
    }
    std::string path;
    for (const auto i : paretoFront(report.points, byOcclusion)) {
        const auto& point = report.points[i];
        const double error = errorOf(point, byOcclusion);
        if (!(error > 0)) continue;
        const double px = x.at(point.milliseconds / 1000), py = y.at(error);
        path += path.empty() ? fmt::format("M{:.1f} {:.1f}", px, py) : fmt::format("H{:.1f}V{:.1f}", px, py);
    }
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.5\"/>\n", path);
    for (const auto& [name, color] : colors) {
        const double at = kTop + 20 * static_cast<double>(color);
        svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
            kWidth - kRight + 24, at, kColors[color % std::size(kColors)], kWidth - kRight + 36, at + 4, escaped(name));
    }
    return svg + "</svg>\n";
}

}  // namespace limn
