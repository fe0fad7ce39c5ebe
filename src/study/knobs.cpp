#include "study/knobs.h"

#include "base/text.h"
#include "render/pipeline.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace limn {
namespace {

constexpr std::string_view kLevel = "scene.subdivision.level", kShadow = "scene.shadow.resolution";

/// Of all passes that run: settings that leave it alone change nothing of a picture.
ContentKey planKey(const Variant& variant, int frame) {
    const RenderConfig& config = variant.config;
    const SceneAt scene = sceneAt(*variant.scene, frameRequest(config, frame));
    const PixelRect block{glm::ivec2(0), largestBlock(config.image.size)};
    const TilePipelines pipelines =
        buildPipelines(config, scene, sceneFacts(scene), frame, kAnyTexture, 0, {block, block});
    KeyBuilder key;
    key.add(pipelines.sampling.samples()).add(pipelines.guard);
    for (const auto& planned : pipelines.averaged.plan.passes) {
        const Pass& pass = pipelines.averaged.graph.passes[static_cast<std::size_t>(planned.pass)];
        key.add(pass.name).add(pass.slot).add(pass.rate).add(pass.note).add(planned.halo);
        key.bytes(pass.params.bytes.data(), pass.params.bytes.size());
        for (const auto& [name, value] : pass.defines) key.add(name).add(value);
    }
    for (const auto& texture : pipelines.averaged.plan.textures)
        key.add(static_cast<int>(texture.format)).add(texture.size.x).add(texture.size.y);
    return key.key();
}

/// Values around a number: a quarter to four times as much. From nothing, which stands for "automatic": powers of two.
std::vector<double> ladder(double current, const FieldInfo& info, bool isInteger) {
    std::set<double> values{current};
    if (current == 0)
        for (const double value : {1, 2, 4, 8, 16}) values.insert(value);
    else
        for (const double factor : {0.25, 0.5, 2.0, 4.0}) values.insert(current * factor);
    std::vector<double> fitting;
    for (double value : values) {
        if (isInteger) value = std::round(value);
        value = std::clamp(value, info.min, info.max);
        if (fitting.empty() || value > fitting.back()) fitting.push_back(value);
    }
    return fitting;
}

std::optional<Knob> knobOf(const Field& field, const void* object, const std::string& key) {
    const FieldType& type = field.type();
    if (!field.info.accuracy) return std::nullopt;
    const std::string current = type.text(field.constMember(object));
    Knob knob{key, {}, 0};
    if (!type.names.empty()) {
        for (const auto name : type.names) knob.values.push_back(fmt::format("\"{}\"", name));
    } else if (type.name == "boolean") {
        knob.values = {"false", "true"};
    } else if (type.name == "integer" || type.name == "number") {
        double number = 0;
        type.toNumbers(field.constMember(object), &number);
        for (const double value : ladder(number, field.info, type.name == "integer"))
            knob.values.push_back(
                numberText(type.name == "integer" ? value : static_cast<double>(static_cast<float>(value))));
    } else {
        return std::nullopt;
    }
    const auto at = std::find(knob.values.begin(), knob.values.end(), current);
    if (at == knob.values.end()) knob.values.insert(knob.values.begin(), current);
    knob.current = at == knob.values.end() ? 0 : static_cast<std::size_t>(at - knob.values.begin());
    return knob;
}

std::string inlineToml(const Node& node) {
    if (const std::string* text = node.text()) return jsonText(*text);
    if (const auto* flag = std::get_if<bool>(&node.value)) return *flag ? "true" : "false";
    if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return std::to_string(*whole);
    if (node.isNumber()) {
        const std::string text = numberText(node.number());
        return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
    }
    std::vector<std::string> parts;
    if (node.isArray()) {
        for (const auto& entry : node.array()) parts.push_back(inlineToml(entry));
        return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    for (const auto& [key, value] : node.table()) parts.push_back(fmt::format("{} = {}", key, inlineToml(value)));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

/// The members that two techniques have in common, as TOML.
std::string sharedSettings(const Technique& technique, const TechniqueChoice& of, std::string_view without) {
    std::string text;
    for (const Field& field : of.technique->schema) {
        const Field* same = findField(technique.schema, field.name);
        if (!same || field.info.accuracy || &same->type() != &field.type() || field.name == without) continue;
        text += fmt::format(", {} = {}", field.name, field.type().text(field.constMember(of.params.get())));
    }
    return text;
}

const Node* filterOf(const Node& document) {
    const Node* ao = document.find("ao");
    return ao ? ao->find("filter") : nullptr;
}

std::shared_ptr<const LoadedScene> changedScene(const LoadedScene& loaded, const Settings& settings) {
    const auto level = settings.find(std::string(kLevel)), shadow = settings.find(std::string(kShadow));
    if (level == settings.end() && shadow == settings.end())
        return {std::shared_ptr<const LoadedScene>(), &loaded};  // not owned
    auto changed = std::make_shared<LoadedScene>(loaded);
    if (level != settings.end())
        for (auto& mesh : changed->scene.meshes)
            if (mesh.subdivision.present)
                mesh.subdivision.level = std::clamp(mesh.subdivision.level + std::stoi(level->second), 0, 10);
    if (shadow != settings.end())
        for (auto& light : changed->scene.lights) {
            int& resolution = light.base.shadow.resolution;
            resolution = std::clamp(static_cast<int>(std::lround(resolution * std::stod(shadow->second))), 16, 16384);
        }
    return changed;
}

}  // namespace

std::string settingsText(const Settings& settings) {
    std::string text;
    for (const auto& [key, value] : settings) text += fmt::format("{}{}={}", text.empty() ? "" : " ", key, value);
    return text.empty() ? "as it is" : text;
}

StudyConfig::StudyConfig(
    Node document, std::filesystem::path path, const LoadedScene& scene, const MeshFileOptions& meshFile)
    : document_(std::move(document)), path_(std::move(path)), meshFile_(meshFile), scene_(scene) {
    // Its settings are what is asked for here.
    std::erase_if(std::get<Node::Table>(document_.value), [](const auto& entry) { return entry.first == "quality"; });
}

Variant StudyConfig::at(const Settings& settings) const {
    Variant variant{document_, {}, {}};
    for (const auto& [key, value] : settings)
        if (!key.starts_with("scene.")) applySetting(variant.document, fmt::format("{}={}", key, value));
    variant.config = parseRenderConfig(variant.document, path_, {{}, {}, meshFile_});
    variant.config.output.aovs = {&aov::beauty};
    variant.config.output.path = "study.png";  // what is measured are pixels
    variant.scene = changedScene(scene_, settings);
    return variant;
}

/// Does a technique, as it is set, find the visibility that rays find? Not with an exponent on it, a radius in the
/// picture, or keyframes, which the truth does not have.
static bool findsVisibility(const TechniqueChoice& choice) {
    if (!findField(choice.technique->schema, "radius") || !choice.tracks.empty()) return false;
    const auto standard = choice.technique->makeParams();
    for (const char* name : {"strength", "power", "mapping", "radius_in", "offset_in"})
        if (const Field* field = findField(choice.technique->schema, name); field
            && field->type().text(field->constMember(choice.params.get()))
                != field->type().text(field->constMember(standard.get())))
            return false;
    return true;
}

std::optional<Settings> StudyConfig::tracedOcclusion(int rays) const {
    const Variant variant = at({});
    const auto& choices = variant.config.in("ao");
    if (choices.empty() || !findsVisibility(choices.front())) return std::nullopt;
    const std::string shared = sharedSettings(*findTechnique("ao", "ray_traced"), choices.front(), "rays");
    return Settings{{"ao", fmt::format("{{ technique = \"ray_traced\", rays = {}{} }}", rays, shared)}};
}

std::vector<Settings> StudyConfig::alternatives() const {
    std::vector<Settings> all;
    if (!tracedOcclusion(1)) return all;
    const TechniqueChoice choice = at({}).config.in("ao").front();
    for (const auto* other : allTechniques()) {
        if (other->slot != "ao" || !findField(other->schema, "radius")) continue;
        const std::string ao = fmt::format("technique = \"{}\"{}", other->name, sharedSettings(*other, choice, ""));
        all.push_back({{"ao", fmt::format("{{ {} }}", ao)}});
        if (const Node* filter = filterOf(document_))
            all.push_back({{"ao", fmt::format("{{ {}, filter = {} }}", ao, inlineToml(*filter))}});
    }
    return all;
}

std::vector<Settings> StudyConfig::otherFilters(const Settings& settings) const {
    std::vector<Settings> all;
    if (at(settings).config.in("ao").empty()) return all;
    Settings bare = settings;
    std::erase_if(bare, [](const auto& entry) { return entry.first.starts_with("ao.filter"); });
    for (const auto* filter : allTechniques()) {
        if (filter->slot != "filter") continue;
        all.push_back(bare);
        all.back()["ao.filter"] = fmt::format("{{ technique = \"{}\" }}", filter->name);
    }
    return all;
}

static std::vector<Knob> sceneKnobs(const Settings& settings) {
    std::vector<Knob> knobs;
    const auto add = [&](std::string_view key, const std::vector<std::string>& values, const std::string& neutral) {
        const auto set = settings.find(std::string(key));
        const auto at = std::find(values.begin(), values.end(), set == settings.end() ? neutral : set->second);
        if (at != values.end())
            knobs.push_back({std::string(key), values, static_cast<std::size_t>(at - values.begin())});
    };
    add(kLevel, {"-2", "-1", "0", "1"}, "0");
    add(kShadow, {"0.25", "0.5", "1", "2"}, "1");
    return knobs;
}

std::vector<Knob> StudyConfig::knobs(const Settings& settings, int frame) const {
    const Variant variant = at(settings);
    std::vector<Knob> found;
    const auto addFields = [&](Schema schema, const void* object, const std::string& prefix) {
        for (const Field& field : schema)
            if (auto knob = knobOf(field, object, prefix + "." + std::string(field.name)))
                found.push_back(std::move(*knob));
    };
    for (const auto& table : configTables())
        if (table.name == "[image]") addFields(table.schema, &variant.config.image, "image");
    for (const auto& slot : allSlots()) {
        const auto& choices = variant.config.in(slot.name);
        for (std::size_t i = 0; i < choices.size(); ++i)
            addFields(choices[i].technique->schema, choices[i].params.get(),
                choices.size() == 1 ? std::string(slot.key) : fmt::format("{}.{}", slot.key, i));
        if (slot.name == "geometry" && choices.size() == 1) {
            Knob accuracy{std::string(slot.key), {}, 0};
            for (const auto* technique : allTechniques()) {
                if (technique->slot != slot.name) continue;
                if (technique == choices.front().technique) accuracy.current = accuracy.values.size();
                accuracy.values.push_back(fmt::format("\"{}\"", technique->name));
            }
            found.push_back(std::move(accuracy));
        }
    }
    for (Knob& knob : sceneKnobs(settings)) found.push_back(std::move(knob));
    const ContentKey now = planKey(variant, frame);
    const auto drawn = sceneAt(*variant.scene, frameRequest(variant.config, frame)).instances;
    const bool hasCages = std::any_of(drawn.begin(), drawn.end(), [](const auto& i) { return i.isSubdivided; });
    std::erase_if(found, [&](Knob& knob) {
        if (knob.key == kLevel) return !hasCages;
        // A knob counts if one of its values plans something else. Values that a config refuses are left out.
        bool matters = false;
        const std::string current = knob.values[knob.current];
        std::erase_if(knob.values, [&](const std::string& value) {
            if (value == current) return false;
            Settings turned = settings;
            turned[knob.key] = value;
            try {
                matters = planKey(at(turned), frame) != now || matters;
                return false;
            } catch (const Errors&) { return true; } catch (const Error&) {
                return true;
            }
        });
        const auto place = std::find(knob.values.begin(), knob.values.end(), current);
        knob.current = static_cast<std::size_t>(place - knob.values.begin());
        return !matters;
    });
    return found;
}

std::string StudyConfig::lines(const Settings& settings) const {
    const Variant variant = at(settings);
    std::set<std::string> tables;
    std::string top, image, scene;
    for (const auto& [key, value] : settings) {
        if (key.starts_with("image."))
            image += fmt::format("{} = {}\n", key.substr(6), value);
        else if (!key.starts_with("scene."))
            tables.insert(key.substr(0, key.find('.')));
    }
    for (const auto& table : tables) top += fmt::format("{} = {}\n", table, inlineToml(*variant.document.find(table)));
    if (settings.contains(std::string(kLevel)))
        for (const auto& mesh : variant.scene->scene.meshes)
            if (mesh.subdivision.present)
                scene += fmt::format(
                    "# [[mesh]] '{}': subdivision.level = {}\n", presentable(mesh.name), mesh.subdivision.level);
    if (settings.contains(std::string(kShadow)))
        for (const auto& light : variant.scene->scene.lights)
            if (light.base.shadow.present)
                scene += fmt::format("# [[light]] '{}': shadow.resolution = {}\n", presentable(light.base.name),
                    light.base.shadow.resolution);
    if (!scene.empty()) scene = "# in the scene file:\n" + scene;
    return top + (image.empty() ? "" : "[image]\n" + image) + scene;
}

}  // namespace limn
