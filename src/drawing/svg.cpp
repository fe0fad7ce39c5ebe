// Drawings as SVG 1.1: millimetres at the sheet's scale, a layer for each visibility and source (Inkscape's layers are
// groups), classes with the look, and the picture below as one PNG.

#include "base/text.h"
#include "drawing/vector_encoder.h"
#include "settings/color.h"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace limn {
namespace {

constexpr const char* kMetadataSpace = "urn:limn:metadata";

/// RFC 4648.
std::string base64(std::span<const std::byte> bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? std::to_integer<unsigned>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Display-encoded, as CSS has it.
std::string hexOf(const Color& color) {
    const auto byte = [](float linear) {
        return static_cast<int>(std::lround(255 * std::clamp(linearToSrgb(linear), 0.0f, 1.0f)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

/// Ten-thousandths of a millimetre, without zeros that say nothing.
std::string number(double millimetres) {
    std::string text = fmt::format("{:.4f}", millimetres);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string pathData(const PaperLine& line) {
    std::string data;
    for (const auto& path : line.paths) {
        const std::size_t count = line.isClosed ? path.size() - 1 : path.size();
        for (std::size_t i = 0; i < count; ++i)
            data += fmt::format("{}{},{}", i == 0 ? "M" : i == 1 ? "L" : " ", number(path[i].x), number(path[i].y));
        if (line.isClosed) data += "Z";
    }
    return data;
}

class SvgEncoder : public VectorEncoder {
public:
    using VectorEncoder::VectorEncoder;
    std::vector<std::byte> finish() override {
        pugi::xml_document document;
        write(document);
        std::ostringstream out;
        document.save(out, " ", pugi::format_indent, pugi::encoding_utf8);
        const std::string text = out.str();
        pugi::xml_document again;
        if (!again.load_buffer(text.data(), text.size())) throw notWhatWasWritten("SVG");
        const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
        return {bytes, bytes + text.size()};
    }

private:
    void write(pugi::xml_document& document) {
        const std::string width = number(drawing_->millimetres(drawing_->size.x)),
                          height = number(drawing_->millimetres(drawing_->size.y));
        pugi::xml_node svg = document.append_child("svg");
        svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
        svg.append_attribute("xmlns:xlink") = "http://www.w3.org/1999/xlink";
        svg.append_attribute("xmlns:inkscape") = "http://www.inkscape.org/namespaces/inkscape";
        svg.append_attribute("version") = "1.1";
        svg.append_attribute("width") = (width + "mm").c_str();
        svg.append_attribute("height") = (height + "mm").c_str();
        svg.append_attribute("viewBox") = fmt::format("0 0 {} {}", width, height).c_str();
        putMetadata(svg);
        const std::vector<PaperGroup> groups = onPaper(*drawing_, options_.simplify);
        std::string css = "\n.line{fill:none;stroke-linecap:round;stroke-linejoin:round}\n";
        for (std::size_t i = 0; i < groups.size(); ++i)
            css += fmt::format(".{}{{stroke:{};stroke-width:{}{}}}\n", classOf(groups, i), hexOf(groups[i].style.color),
                number(groups[i].style.width),
                groups[i].opacity < 1 ? fmt::format(";stroke-opacity:{:.3f}", groups[i].opacity) : "");
        svg.append_child("style").text() = css.c_str();
        if (picture_) {
            pugi::xml_node image = svg.append_child("image");
            image.append_attribute("id") = "picture";
            image.append_attribute("width") = width.c_str();
            image.append_attribute("height") = height.c_str();
            image.append_attribute("preserveAspectRatio") = "none";
            image.append_attribute("xlink:href") = ("data:image/png;base64," + base64(picture_->finish())).c_str();
        }
        for (std::size_t i = 0; i < groups.size(); ++i) putGroup(svg, groups[i], classOf(groups, i));
    }

    void putMetadata(pugi::xml_node svg) const {
        pugi::xml_node node = svg.append_child("metadata");
        node.append_attribute("xmlns:limn") = kMetadataSpace;
        for (const auto& [key, value] : metadata_) {
            pugi::xml_node entry = node.append_child("limn:entry");
            entry.append_attribute("name") = key.c_str();
            entry.text() = repairedText(value).c_str();
        }
    }

    /// "contours", "hidden-creases"; of a second layer "contours-2".
    static std::string classOf(const std::vector<PaperGroup>& groups, std::size_t index) {
        const auto nameOf = [](const PaperGroup& group) {
            return fmt::format("{}{}", group.isHidden ? "hidden-" : "",
                enumNames<MeshLineSource>[static_cast<std::size_t>(group.source)]);
        };
        int same = 1;
        for (std::size_t i = 0; i < index; ++i) same += nameOf(groups[i]) == nameOf(groups[index]);
        return nameOf(groups[index]) + (same > 1 ? fmt::format("-{}", same) : "");
    }

    void putGroup(pugi::xml_node svg, const PaperGroup& group, const std::string& name) const {
        pugi::xml_node node = svg.append_child("g");
        node.append_attribute("id") = name.c_str();
        node.append_attribute("inkscape:groupmode") = "layer";
        node.append_attribute("inkscape:label") = name.c_str();
        for (const auto& line : group.lines) {
            pugi::xml_node path = node.append_child("path");
            path.append_attribute("class") = ("line " + name).c_str();
            const std::string object = repairedText(objectOf(*drawing_, *line.line)),
                              material = repairedText(drawing_->materials[line.line->material]);
            if (!object.empty()) path.append_attribute("data-object") = object.c_str();
            if (!material.empty()) path.append_attribute("data-material") = material.c_str();
            std::string style;
            if (!(line.color == group.style.color)) style += fmt::format("stroke:{};", hexOf(line.color));
            if (std::abs(line.width - group.style.width) > 1e-6)
                style += fmt::format("stroke-width:{};", number(line.width));
            if (std::abs(line.opacity - group.opacity) > 1e-3)
                style += fmt::format("stroke-opacity:{:.3f};", line.opacity);
            if (!style.empty()) path.append_attribute("style") = style.c_str();
            path.append_attribute("d") = pathData(line).c_str();
        }
    }
};

std::unique_ptr<ImageEncoder> openSvg(
    std::span<const Layer> layers, int height, const Metadata& metadata, const EncodeOptions& options) {
    EncodeOptions packed = options;  // the picture is text in the file
    packed.compression = 9;
    return std::make_unique<SvgEncoder>(layers, height, metadata, packed);
}

std::optional<Metadata> readWholeSvg(const std::filesystem::path& path) {
    pugi::xml_document document;
    if (!document.load_file(path.c_str()) || !document.child("svg")) return std::nullopt;
    Metadata found;
    for (const auto& entry : document.child("svg").child("metadata").children("limn:entry"))
        found.emplace_back(entry.attribute("name").value(), entry.text().get());
    return found;
}

const ImageFormat kSvg{{".svg"}, "lines from the mesh as vectors in millimetres, layer by layer, over the picture",
    {.isVector = true}, openSvg, readWholeSvg};

}  // namespace
}  // namespace limn
