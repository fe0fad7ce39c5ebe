#include "render/config.h"

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "scene/frames.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace limn {
namespace {

struct Header {
    std::string scene, camera, frames;
    std::vector<std::string> sections;
};
constexpr Field kHeader[] = {
    field<&Header::scene>("scene", {.required = true}, "Scene file or OBJ, relative to this file."),
    field<&Header::camera>("camera", "Name of the camera; the scene's first if left out."),
    field<&Header::sections>(
        "sections", "Names of the scene's sections to cut it open by; those without a name always do."),
    field<&Header::frames>("frames", "Range of frames to draw, such as \"1-24\"; replaces the scene's."),
};

constexpr Field kImage[] = {
    field<&ImageSettings::size>(
        "size", {.unit = "pixels", .min = 1, .max = 65536, .keyable = false}, "Width and height of the picture."),
    field<&ImageSettings::samples>("samples", {.min = 1, .max = 4096, .accuracy = true, .keyable = false},
        "Samples per pixel: antialiasing, and less noise."),
    field<&ImageSettings::aoSamples>("ao_samples", {.min = 0, .max = 4096, .accuracy = true, .keyable = false},
        "In how many of these samples ambient occlusion is found; 0: in a half, but at least four. It is smooth: more "
        "make it less noisy, but hardly sharper."),
    field<&ImageSettings::lineSamples>("line_samples", {.min = 0, .max = 4096, .accuracy = true, .keyable = false},
        "In how many of these samples lines are found; 0: in a quarter, but at least four. Lines have smooth borders "
        "from one sample on: more are for folds and gaps as narrow as a pixel."),
    field<&ImageSettings::shutter>("shutter", {.unit = "frames", .min = 0, .max = 100, .keyable = false},
        "How long the shutter is open around each frame's time: what moves blurs, lines too. Each sample then shows a "
        "moment of its own: take 16 or more. 0: nothing blurs."),
    field<&ImageSettings::guard>("guard",
        {.unit = "longer sides", .min = 0, .max = 1, .accuracy = true, .keyable = false},
        "How wide a band around the picture may be drawn for effects that look around themselves; made only as wide as "
        "they need, and at most 512 pixels."),
    field<&ImageSettings::tile>("tile", {.unit = "pixels", .min = 0, .max = 65536, .keyable = false},
        "Draw the picture in tiles of at most this size each way; 0: as large as memory allows. The picture is the "
        "same to the bit."),
    field<&ImageSettings::dpi>(
        "dpi", {.unit = "pixels per inch", .min = 1, .max = 100000}, "Gives millimetres a meaning."),
};

constexpr Field kQuality[] = {
    field<&QualitySettings::error>("error", {.min = 1e-5, .max = 1, .keyable = false},
        "Chooses ambient occlusion so that its root mean square error beside rays is at most this, as cheap as can "
        "be."),
    field<&QualitySettings::seconds>("seconds", {.unit = "seconds", .min = 1e-3, .max = 1e6, .keyable = false},
        "Chooses samples and ambient occlusion so that drawing a frame on this machine takes at most about as long."),
};

enum class Orientation { portrait, landscape };

struct Sheet {
    std::string size, scale;
    Orientation orientation = Orientation::portrait;
};

}  // namespace

template <>
inline constexpr std::array<std::string_view, 2> enumNames<Orientation> = {"portrait", "landscape"};

namespace {

constexpr Field kSheet[] = {
    field<&Sheet::size>("size", {.required = true},
        "\"A0\" to \"A6\", or width and height in millimetres: \"600x400\". With image.dpi it gives the picture's "
        "size."),
    field<&Sheet::orientation>("orientation", "portrait: the sheet's short side below; landscape: its long side."),
    field<&Sheet::scale>("scale",
        "\"1:50\": a metre of the scene is 20 mm on paper. Needs an orthographic camera; without it the camera says "
        "what the sheet shows."),
};

/// Millimetres, the short side first; nullopt for a name that is none.
std::optional<glm::dvec2> paperSize(const std::string& name) {
    constexpr double series[][2] = {
        {841, 1189}, {594, 841}, {420, 594}, {297, 420}, {210, 297}, {148, 210}, {105, 148}};
    if (name.size() == 2 && (name[0] == 'A' || name[0] == 'a') && name[1] >= '0' && name[1] <= '6')
        return glm::dvec2(series[name[1] - '0'][0], series[name[1] - '0'][1]);
    const auto cross = name.find('x');
    if (cross == std::string::npos) return std::nullopt;
    const auto width = parseNumber(name.substr(0, cross)), height = parseNumber(name.substr(cross + 1));
    if (!width || !height || !(*width > 0 && *height > 0 && *width <= 10000 && *height <= 10000)) return std::nullopt;
    return glm::dvec2(*width, *height);
}

/// "1:50" → 0.02.
std::optional<double> parseScale(const std::string& text) {
    const auto colon = text.find(':');
    if (colon == std::string::npos) return std::nullopt;
    const auto paper = parseNumber(text.substr(0, colon)), world = parseNumber(text.substr(colon + 1));
    if (!paper || !world || !(*paper > 0 && *world > 0 && std::isfinite(*paper / *world))) return std::nullopt;
    return *paper / *world;
}

constexpr Field kOutput[] = {
    field<&EncodeOptions::bits>("bits", {.min = 8, .max = 16}, "Bits per channel of PNG and TIFF: 8 or 16."),
    field<&EncodeOptions::compression>("compression", {.min = 0, .max = 9}, "Compression of PNG: 1 fast to 9 small."),
    field<&EncodeOptions::quality>("quality", {.min = 1, .max = 100}, "Quality of JPEG."),
    field<&EncodeOptions::simplify>("simplify", {.unit = "millimetres", .min = 0, .max = 10},
        "SVG and PDF: how far a line may leave its place to have fewer points."),
    field<&EncodeOptions::underlay>("underlay", "SVG and PDF: does the picture lie below the lines?"),
};

/// The techniques that the value of a slot's key chooses.
std::vector<TechniqueChoice> readSlot(const Slot& slot, const Node& node, ErrorCollector& errors) {
    std::vector<std::string_view> children;
    for (const auto& other : allSlots())
        if (other.parent() == slot.key) children.push_back(other.ownKey());
    std::vector<TechniqueChoice> choices;
    if (node.isArray() && slot.fill != Slot::Fill::one)
        for (const auto& entry : node.array())
            choices.push_back(readChoice(entry, slot, slot.label(), errors, children));
    else
        choices.push_back(readChoice(node, slot, slot.label(), errors, children));
    return choices;
}

/// The table of a slot that a path names, and the slot's key: "edges.0" is an entry of the slot "edges", "ao.filter" a
/// slot of its own. Null where there is no such table.
std::pair<Node*, std::string> findTable(Node& document, const std::string& path) {
    Node* node = &document;
    std::string key;
    std::istringstream parts(path);
    const auto enter = [&](std::size_t entry) {
        auto* list = std::get_if<Node::Array>(&node->value);
        if (list) node = entry < list->size() ? &(*list)[entry] : nullptr;
        return list != nullptr;
    };
    for (std::string word; node && std::getline(parts, word, '.');) {
        const auto index = parseNumber(word);
        const bool isEntry = index && *index >= 0 && *index < 1e6;
        if (enter(isEntry ? static_cast<std::size_t>(*index) : 0) && index) continue;
        if (node) node = node->find(word);
        key += (key.empty() ? "" : ".") + word;
    }
    if (node) enter(0);
    return {node && node->isTable() ? node : nullptr, key};
}

/// `--set ao.technique=NAME` puts another technique over the settings of the old one: those that it does not have are
/// left out, and named.
void dropForeignKeys(Node& document, const std::string& setting) {
    const auto equals = setting.find('=');
    const std::string path = setting.substr(0, equals);
    constexpr std::string_view last = ".technique";
    if (equals == std::string::npos || !path.ends_with(last)) return;
    const auto [table, key] = findTable(document, path.substr(0, path.size() - last.size()));
    const Slot* slot = nullptr;
    for (const auto& candidate : allSlots())
        if (candidate.key == key) slot = &candidate;
    const Technique* technique = slot ? findTechnique(slot->name, setting.substr(equals + 1)) : nullptr;
    if (!table || !technique) return;
    std::set<std::string, std::less<>> known{"technique", "mode"};
    for (const auto& field : technique->schema) known.emplace(field.name);
    for (const auto& inner : allSlots())
        if (inner.parent() == slot->key) known.emplace(inner.ownKey());
    std::vector<std::string> dropped;
    std::erase_if(std::get<Node::Table>(table->value), [&](const auto& entry) {
        const std::string* preset = entry.first == "preset" ? entry.second.text() : nullptr;
        const bool isForeign = !known.contains(entry.first)
            && std::none_of(technique->presets.begin(), technique->presets.end(),
                [&](const auto& p) { return preset && p.name == *preset; });
        if (isForeign) dropped.push_back(entry.first);
        return isForeign;
    });
    if (!dropped.empty())
        log::warning("--set {}: without {}, which the config says of another technique", setting, joinAnd(dropped));
}

/// A config without what says only where its pictures go and which are drawn: they stay what they are if that changes.
Node shownBy(Node document) {
    const auto drop = [](Node& table, std::string_view key) {
        std::erase_if(std::get<Node::Table>(table.value), [&](const auto& entry) { return entry.first == key; });
    };
    if (!document.isTable()) return document;
    drop(document, "frames");
    drop(document, "study");
    if (Node* output = document.find("output"); output && output->isTable()) {
        drop(*output, "path");
        drop(*output, "video");
    }
    return document;
}

class ConfigReader {
public:
    ConfigReader(Node document, const std::filesystem::path& path, const ConfigOverrides& overrides)
        : document_(std::move(document)), overrides_(overrides) {
        layerSettings(document_, overrides.settings);
        config_.file = path;
        KeyBuilder key;
        key.add(canonicalText(shownBy(document_))).add(overrides.camera).add(overrides.meshFile.subdivide.value_or(-1));
        if (overrides.meshFile.up) key.add(*overrides.meshFile.up);
        config_.hash = key.key().hex();
    }

    RenderConfig read() {
        if (!document_.find("scene") && (document_.find("mesh") || document_.find("instance")))
            throw Error(ExitCode::usage, {config_.file.string()}, "is a scene, not a config",
                "write a config that begins with scene = \"FILE\", or have limn init write both for a mesh");
        std::vector<std::string_view> sections{"version", "image", "sheet", "quality", "study", "output"};
        for (const auto& slot : allSlots())
            if (slot.parent().empty()) sections.push_back(slot.key);
        Header header;
        readVersion(document_, "the config", errors_);
        readFields(document_, kHeader, &header, nullptr, "the config", errors_, sections);
        config_.camera = overrides_.camera.empty() ? header.camera : overrides_.camera;
        config_.meshFile = overrides_.meshFile;
        config_.sections = header.sections;
        if (!header.scene.empty()) {
            config_.scene = pathIn(*document_.find("scene"));
            if (!fileExists(config_.scene))
                fail(*document_.find("scene"), fmt::format("the scene '{}' does not exist", config_.scene.string()),
                    "paths are relative to the file that names them", ExitCode::missingInput);
        }
        if (!header.frames.empty() && !(config_.frames = parseFrameRange(header.frames)))
            fail(*document_.find("frames"), fmt::format("frames '{}' is no range", header.frames),
                fmt::format("write for example \"1-24\", with at most {} frames", kMostFrames));
        readImage();
        readSheet();
        readQuality();
        config_.choices = readChoices(document_, errors_);
        readOutput();
        errors_.throwIfAny();
        return std::move(config_);
    }

private:
    void fail(const Node& node, std::string problem, std::string remedy, ExitCode code = ExitCode::usage) {
        errors_.add({code, node.where, std::move(problem), std::move(remedy)});
    }

    void readImage() {
        const Node* node = document_.find("image");
        if (!node) return;
        static constexpr std::string_view alsoKnown[] = {"seed", "background"};
        readFields(*node, kImage, &config_.image, nullptr, "[image]", errors_, alsoKnown);
        if (const Node* seed = node->find("seed")) {
            const auto* number = std::get_if<std::int64_t>(&seed->value);
            if (seed->text() && *seed->text() == "frame")
                config_.image.seedIsFrame = true;
            else if (seed->text() && *seed->text() == "surface")
                config_.image.seedIsSurface = true;
            else if (number && *number >= 0 && *number < (std::int64_t{1} << 31))
                config_.image.seed = static_cast<unsigned>(*number);
            else
                fail(*seed, "'seed' in [image] must be a whole number from 0, \"frame\" or \"surface\"", "");
        }
        if (const Node* background = node->find("background")) {
            if (background->text() && *background->text() == "transparent")
                config_.image.transparent = true;
            else if (auto problem = fieldType<Color>().read(&config_.image.background, *background, kImage[0]))
                fail(*background, "'background' in [image] " + *problem, "or \"transparent\"");
        }
    }

    void readQuality() {
        const Node* node = document_.find("quality");
        if (!node) return;
        readFields(*node, kQuality, &config_.quality, nullptr, "[quality]", errors_);
        if (node->isTable() && (node->find("error") != nullptr) == (node->find("seconds") != nullptr))
            fail(*node, "[quality] needs one of 'error' and 'seconds'", "write for example quality = { error = 0.02 }");
    }

    void readSheet() {
        const Node* node = document_.find("sheet");
        if (!node) return;
        Sheet sheet;
        readFields(*node, kSheet, &sheet, nullptr, "[sheet]", errors_);
        if (const Node* image = document_.find("image"); image && image->find("size"))
            fail(*image->find("size"), "'size' in [image] stands beside [sheet]",
                "the sheet's size and image.dpi give the picture's: remove one of the two");
        if (sheet.size.empty()) return;
        if (const auto paper = paperSize(sheet.size)) {
            const bool named = sheet.size.find('x') == std::string::npos;
            const glm::dvec2 millimetres =
                named && sheet.orientation == Orientation::landscape ? glm::dvec2(paper->y, paper->x) : *paper;
            const glm::dvec2 pixels = millimetres / 25.4 * config_.image.dpi;
            if (std::max(pixels.x, pixels.y) > 65536)
                fail(*node->find("size"),
                    fmt::format("the sheet has {:.0f}×{:.0f} pixels at {} dpi, more than 65536", pixels.x, pixels.y,
                        config_.image.dpi),
                    "lower image.dpi");
            config_.image.size = glm::max(glm::ivec2(glm::round(pixels)), glm::ivec2(1));
        } else {
            fail(*node->find("size"), fmt::format("'{}' is no sheet", sheet.size),
                "write \"A1\" or, in millimetres, \"600x400\"");
        }
        if (sheet.scale.empty()) return;
        if (const auto scale = parseScale(sheet.scale))
            config_.scale = *scale;
        else
            fail(*node->find("scale"), fmt::format("'{}' is no scale", sheet.scale), "write for example \"1:50\"");
    }

    void readOutput() {
        static constexpr std::string_view alsoKnown[] = {"path", "aovs", "video"};
        const Node* node = document_.find("output");
        const Node* path = node ? node->find("path") : nullptr;
        if (node) {
            readFields(*node, kOutput, &config_.output.encode, nullptr, "[output]", errors_, alsoKnown);
            if (config_.output.encode.bits != 8 && config_.output.encode.bits != 16)
                fail(*node->find("bits"), "'bits' in [output] must be 8 or 16", "");
            if (path && !path->text())
                fail(*path, "'path' in [output] must be text", "");
            else if (path)
                config_.output.path = pathIn(*path);
            if (const Node* aovs = node->find("aovs")) readAovs(*aovs);
            const Node* video = node->find("video");
            if (video && !video->text())
                fail(*video, "'video' in [output] must be text", "");
            else if (video)
                config_.output.video = pathIn(*video);
        }
        // A density that the config chose goes into the file, for printers.
        if (const Node* image = document_.find("image"); document_.find("sheet") || (image && image->find("dpi")))
            config_.output.encode.dpi = config_.image.dpi;
        // The default path: the config's name in the working directory.
        if (config_.output.path.empty()) config_.output.path = config_.file.stem().string() + ".png";
        if (!imageFormat(config_.output.path))
            fail(path ? *path : document_, fmt::format("'{}' is no picture file", config_.output.path.string()),
                "end the path in " + imageExtensions());
    }

    void readAovs(const Node& node) {
        config_.output.aovs.clear();
        if (!node.isArray())
            return fail(node, "'aovs' in [output] must be a list of names", "write aovs = [\"beauty\", \"depth\"]");
        std::vector<std::string> names;
        for (const Aov* aov : allAovs()) names.emplace_back(aov->name);
        for (const auto& entry : node.array()) {
            const Aov* aov = entry.text() ? findAov(*entry.text()) : nullptr;
            if (!aov)
                fail(entry, fmt::format("there is no AOV '{}'", entry.text() ? *entry.text() : "?"),
                    nameRemedy(entry.text() ? *entry.text() : "", names));
            else if (std::find(config_.output.aovs.begin(), config_.output.aovs.end(), aov)
                == config_.output.aovs.end())
                config_.output.aovs.push_back(aov);
            if (aov && !isMade(*aov))
                fail(entry, fmt::format("nothing makes the AOV '{}'", aov->name), makerRemedy(*aov));
        }
        if (node.array().empty()) fail(node, "'aovs' in [output] is empty", "name at least \"beauty\"");
    }

    /// The slots that make an AOV: those that promise it, or those of its only technique.
    static std::vector<const Slot*> makers(const Aov& aov) {
        std::vector<const Slot*> slots;
        for (const auto& slot : allSlots()) {
            const bool promises = std::find(slot.promises.begin(), slot.promises.end(), &aov) != slot.promises.end();
            if (promises || findTechnique(slot.name, aov.onlyBy)) slots.push_back(&slot);
        }
        return slots;
    }

    /// Is a slot filled that makes the AOV? The frame's plan tells whether its technique really does.
    bool isMade(const Aov& aov) const {
        const auto slots = makers(aov);
        return slots.empty() || std::any_of(slots.begin(), slots.end(), [&](const Slot* slot) {
            return !config_.in(slot->name).empty();
        });
    }

    static std::string makerRemedy(const Aov& aov) {
        const Slot& slot = *makers(aov).front();
        const std::string table =
            slot.fill == Slot::Fill::layers ? fmt::format("[[{}]]", slot.key) : fmt::format("[{}]", slot.key);
        if (aov.onlyBy.empty()) return fmt::format("add a table {}", table);
        return fmt::format("add a table {} with technique = \"{}\"", table, aov.onlyBy);
    }

    Node document_;
    const ConfigOverrides& overrides_;
    RenderConfig config_;
    ErrorCollector errors_;
};

}  // namespace

bool OutputSettings::isVector() const {
    const ImageFormat* format = imageFormat(path);
    return format && format->traits.isVector && std::find(aovs.begin(), aovs.end(), &aov::beauty) != aovs.end();
}

std::vector<SettingsTable> configTables() {
    return {{"", "top of the file", kHeader, defaultsOf<Header>()},
        {"[image]",
            "the picture; also seed (a number, \"frame\" or \"surface\": noise moves along) and background (a colour "
            "or \"transparent\")",
            kImage, defaultsOf<ImageSettings>()},
        {"[quality]", "a promise that limn keeps, instead of settings chosen by hand", kQuality,
            defaultsOf<QualitySettings>()},
        {"[sheet]", "paper to draw on, instead of image.size", kSheet, defaultsOf<Sheet>()},
        {"[output]",
            "what is written; also path (#### is the frame number), aovs (a list) and video (a film of all frames: "
            ".mp4, .webm or .gif)",
            kOutput, defaultsOf<EncodeOptions>()}};
}

std::string_view quickstartStyle() {
    return R"([image]
size = [1280, 720]
samples = 8
ao_samples = 2
background = "#f4efe4"

[shading]
technique = "toon"
bands = 4
floor = 0.28

[ao]
technique = "toon_ssao"
radius = "4%"
points = 16
filter = { technique = "plane_aware", passes = 4 }

[[edges]]
technique = "depth_normal"
width = "2px"
color = "#2a2320"
)";
}

Choices readChoices(const Node& document, ErrorCollector& errors) {
    Choices choices;
    for (const auto& slot : allSlots()) {
        const Node* table = slot.parent().empty() ? &document : document.find(slot.parent());
        if (const Node* node = table ? table->find(slot.ownKey()) : nullptr)
            choices[std::string(slot.name)] = readSlot(slot, *node, errors);
        else if (!slot.fallback.empty())
            choices[std::string(slot.name)] = {defaultChoice(slot.name, slot.fallback)};
    }
    return choices;
}

const std::vector<TechniqueChoice>& RenderConfig::in(std::string_view slot) const {
    static const std::vector<TechniqueChoice> none;
    const auto found = choices.find(slot);
    return found == choices.end() ? none : found->second;
}

FrameRequest frameRequest(const RenderConfig& config, double frame) {
    return {
        config.file.string(), config.camera, frame, config.image.size, config.image.dpi, config.sections, config.scale};
}

RenderConfig parseRenderConfig(Node document, const std::filesystem::path& path, const ConfigOverrides& overrides) {
    return ConfigReader(std::move(document), path, overrides).read();
}

void layerSettings(Node& document, std::span<const std::string> settings) {
    for (const auto& setting : settings) {
        applySetting(document, setting);
        dropForeignKeys(document, setting);
    }
}

Node readConfigDocument(const std::filesystem::path& path) {
    if (!isMeshFile(path)) return readDocument(path);
    if (!fileExists(path)) throw Error(ExitCode::missingInput, {path.string()}, "does not exist", "check the path");
    Node document = parseDocument(quickstartStyle(), "the quickstart's style");
    std::get<Node::Table>(document.value).emplace_back("scene", Node{{path.string()}, path.filename().string(), {}});
    return document;
}

RenderConfig readRenderConfig(const std::filesystem::path& path, const ConfigOverrides& overrides) {
    return parseRenderConfig(readConfigDocument(path), path, overrides);
}

}  // namespace limn
