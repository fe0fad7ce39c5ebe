// limn techniques: every slot, technique and parameter, from the program's own tables.

#include "base/text.h"
#include "cli/commands.h"
#include "formats/scene_file.h"
#include "settings/document.h"
#include "study/sweep.h"

#include <fmt/format.h>

#include <cstdio>

namespace limn::cli {
namespace {

/// One parameter, for people and programs.
struct Row {
    std::string name, type, standard, range, unit, doc;
    bool accuracy, keyable;
};

std::vector<Row> rows(Schema schema, const void* defaults) {
    std::vector<Row> result;
    for (const auto& f : schema)
        result.push_back({std::string(f.name), typeText(f),
            f.info.required ? "required" : f.type().text(f.constMember(defaults)), rangeText(f),
            std::string(f.info.unit), std::string(f.doc), f.info.accuracy, f.info.keyable && f.type().components > 0});
    return result;
}

/// The config's key for the technique: the output can be pasted into a config.
std::string_view keyOf(const Technique& technique) { return findSlot(technique.slot)->key; }

std::string textOf(const std::vector<Row>& table) {
    std::string out;
    for (const auto& row : table) {
        out += fmt::format("    {:<20} {}  ({}{}{}{}{})\n", row.name, row.standard.empty() ? "\"\"" : row.standard,
            row.type, row.range.empty() ? "" : ", " + row.range, row.unit.empty() ? "" : ", " + row.unit,
            row.keyable ? ", may be keyed" : "", row.accuracy ? ", buys accuracy" : "");
        out += fmt::format("    {:<20} {}\n", "", row.doc);
    }
    return out;
}

std::string textOf(const Technique& technique) {
    std::string out = fmt::format("{} = \"{}\"\n    {}\n", keyOf(technique), technique.name, technique.doc)
        + textOf(rows(technique.schema, technique.makeParams().get()));
    for (const auto& preset : technique.presets)
        out += fmt::format("    {:<20} {}\n",
            preset.name == "paper" ? "mode = \"paper\"" : fmt::format("preset = \"{}\"", preset.name), preset.doc);
    return out;
}

std::string textOf(const SettingsTable& table, std::string_view file) {
    const std::string head = table.name.empty() ? fmt::format("{}: {}", file, table.doc)
                                                : fmt::format("{} of {}: {}", table.name, file, table.doc);
    return head + "\n" + textOf(rows(table.schema, table.defaults));
}

/// The table's last word: "[[light]] shadow" is asked for as "shadow".
std::string topicOf(const SettingsTable& table) {
    std::string name(table.name.substr(table.name.rfind(' ') + 1));
    std::erase_if(name, [](char c) { return c == '[' || c == ']'; });
    return name;
}

constexpr std::string_view kFrames = R"(frames
    A scene declares them, and --frames of limn render chooses:
        [animation]
        frames = "1-240"
        fps = 24
    --frames takes 12, 1-100, 1-100x2 (every second), 10-1 (backwards) and lists of those: 1,5,9-12.
    #### in output.path is the frame's number, with as many digits. A [[mesh]] file = "walk_####.obj" has a file for
    each frame.

    What "may be keyed" takes keyframes in place of a value, each of a frame and a value:
        translate = { keys = [[1, [0, 0, 0]], [24, [2, 0, 0]]], interpolation = "linear" }
    or one of its numbers: translate = { x = { keys = [[1, 0], [24, 2]] } }; colours have r, g and b.
    interpolation is linear (without it), constant, smooth, spline (through all keys without corners) or bezier, with
    handles as animation programs have them: [frame, value, [left frame, value], [right frame, value]].
    beyond, before the first keyframe and after the last: hold (without it), linear, repeat, offset (again, moved on by
    what a round brings) or mirror. --set replaces all of them by one value.

    Instances, [[node]]s (places without a mesh), cameras and lights may have a parent, and move with it. A mesh with
    numbered files may say which of them a frame shows: sequence = { first = 1, last = 24, ends = "loop" }.

    A turntable of 120 frames, of which the last goes on with the first:
        [animation]
        frames = "1-120"
        [[camera]]
        position = [0, 1.6, 5]
        look_at = [0, 0.8, 0]
        orbit = { keys = [[1, 0], [121, 360]] }
)";

std::string jsonOf(const Technique& technique) {
    std::string out = fmt::format("  {{\"slot\": {}, \"key\": {}, \"name\": {}, \"doc\": {}, \"parameters\": [",
        jsonText(technique.slot), jsonText(keyOf(technique)), jsonText(technique.name), jsonText(technique.doc));
    bool first = true;
    for (const auto& row : rows(technique.schema, technique.makeParams().get())) {
        out += fmt::format(
            "{}\n    {{\"name\": {}, \"type\": {}, \"default\": {}, \"range\": {}, \"unit\": {}, \"doc\": {}, "
            "\"accuracy\": {}, \"keyable\": {}}}",
            first ? "" : ",", jsonText(row.name), jsonText(row.type), jsonText(row.standard), jsonText(row.range),
            jsonText(row.unit), jsonText(row.doc), row.accuracy, row.keyable);
        first = false;
    }
    out += "], \"presets\": [";
    first = true;
    for (const auto& preset : technique.presets) {
        out += fmt::format("{}{{\"name\": {}, \"doc\": {}, \"settings\": {}}}", first ? "" : ", ",
            jsonText(preset.name), jsonText(preset.doc), jsonText(preset.settings));
        first = false;
    }
    return out + "]}";
}

std::string jsonOf(const std::vector<const Technique*>& techniques) {
    std::string slots, list;
    for (const auto& slot : allSlots())
        slots +=
            fmt::format("{}  {{\"name\": {}, \"key\": {}, \"fallback\": {}, \"doc\": {}}}", slots.empty() ? "" : ",\n",
                jsonText(slot.name), jsonText(slot.key), jsonText(slot.fallback), jsonText(slot.doc));
    for (const auto* technique : techniques) list += (list.empty() ? "" : ",\n") + jsonOf(*technique);
    return fmt::format(
        "{{\"version\": {}, \"slots\": [\n{}\n], \"techniques\": [\n{}\n]}}\n", kFormatVersion, slots, list);
}

std::string escapedCell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\|");
    return text;
}

std::string markdownTable(const std::vector<Row>& table) {
    if (table.empty()) return "No parameters.\n";
    std::string out = "| parameter | type | default | range | unit | meaning |\n|---|---|---|---|---|---|\n";
    for (const auto& row : table)
        out += fmt::format("| `{}` | {}{} | `{}` | {} | {} | {}{} |\n", row.name, row.type,
            row.keyable ? ", keyable" : "", escapedCell(row.standard), row.range, row.unit, escapedCell(row.doc),
            row.accuracy ? " *Buys accuracy with time.*" : "");
    return out;
}

std::string markdownOf(const Technique& technique) {
    std::string out = fmt::format("### {} = \"{}\"\n\n{}\n\n{}", keyOf(technique), technique.name, technique.doc,
        markdownTable(rows(technique.schema, technique.makeParams().get())));
    for (const auto& preset : technique.presets)
        out += fmt::format("\n`{} = \"{}\"`: {} (`{}`)\n", preset.name == "paper" ? "mode" : "preset", preset.name,
            preset.doc, preset.settings.empty() ? "no change" : preset.settings);
    return out + "\n";
}

std::string markdownOf(const SettingsTable& table) {
    return fmt::format("### {}{}\n\n{}", table.name.empty() ? "" : fmt::format("`{}`: ", table.name), table.doc,
        markdownTable(rows(table.schema, table.defaults)));
}

/// What a name stands for: techniques by their name or slot, tables of configs and scenes.
struct Topic {
    std::vector<const Technique*> techniques;
    std::vector<SettingsTable> ofConfig, ofScene;
    bool frames = false;
    std::vector<std::string> names;  ///< that there are

    bool empty() const { return techniques.empty() && ofConfig.empty() && ofScene.empty() && !frames; }
};

Topic findTopic(const std::string& name) {
    Topic topic;
    topic.names = {"config", "scene", "frames"};
    for (const auto* technique : allTechniques()) {
        topic.names.emplace_back(technique->name);
        if (std::find(topic.names.begin(), topic.names.end(), std::string(technique->slot)) == topic.names.end())
            topic.names.emplace_back(technique->slot);
        if (name.empty() || technique->name == name || technique->slot == name) topic.techniques.push_back(technique);
    }
    const auto choose = [&](const auto& tables, std::string_view file, std::vector<SettingsTable>& chosen) {
        for (const auto& table : tables) {
            if (!table.name.empty()) topic.names.push_back(topicOf(table));
            if (name.empty() || name == file || (!table.name.empty() && name == topicOf(table)))
                chosen.push_back(table);
        }
    };
    choose(configTables(), "config", topic.ofConfig);
    choose(sweepTables(), "config", topic.ofConfig);
    choose(sceneTables(), "scene", topic.ofScene);
    topic.frames = name.empty() || name == "frames" || name == "animation";
    return topic;
}

ExitCode run(const std::string& name, const std::string& format) {
    const Topic topic = findTopic(name);
    if (topic.empty())
        throw Error(ExitCode::usage, {}, fmt::format("there is no technique, slot or table '{}'", name),
            nameRemedy(name, topic.names));
    if (format == "markdown" && name.empty()) {
        fmt::print("{}", parameterReference());
        return ExitCode::done;
    }
    if (format == "json") {
        fmt::print("{}", jsonOf(topic.techniques));
        return ExitCode::done;
    }
    const bool isMarkdown = format == "markdown";
    for (const auto& table : topic.ofConfig)
        fmt::print("{}\n", isMarkdown ? markdownOf(table) : textOf(table, "a config"));
    for (const auto* technique : topic.techniques)
        fmt::print("{}", isMarkdown ? markdownOf(*technique) : textOf(*technique) + "\n");
    for (const auto& table : topic.ofScene)
        fmt::print("{}\n", isMarkdown ? markdownOf(table) : textOf(table, "a scene"));
    if (topic.frames) fmt::print("{}", kFrames);
    return ExitCode::done;
}

}  // namespace

std::string parameterReference() {
    std::string out = "# Parameter reference\n\nMade from the program's own tables.\n\n## Render config\n\n";
    for (const auto& tables : {configTables(), sweepTables()})
        for (const auto& table : tables) out += markdownOf(table) + "\n";
    out += "## Techniques\n\n";
    for (const auto& slot : allSlots()) {
        out += fmt::format("{} Without a word about it: {}.\n\n", slot.doc,
            slot.fallback.empty() ? "nothing, at no cost" : fmt::format("`{}`", slot.fallback));
        for (const auto* technique : allTechniques())
            if (technique->slot == slot.name) out += markdownOf(*technique);
    }
    out += "## Scene file\n\n";
    for (const auto& table : sceneTables()) out += markdownOf(table) + "\n";
    out += fmt::format("## Frames and keyframes\n\n```\n{}```\n\n", kFrames.substr(kFrames.find('\n') + 1));
    out += "## Images (AOVs)\n\n| name | format | meaning |\n|---|---|---|\n";
    for (const Aov* aov : allAovs())
        out += fmt::format("| `{}` | {} | {} |\n", aov->name, info(aov->format).name, aov->doc);
    return out;
}

void addTechniques(CLI::App& app, Chosen& chosen) {
    auto name = std::make_shared<std::string>();
    auto format = std::make_shared<std::string>("text");
    auto* command =
        app.add_subcommand("techniques", "List every table, slot, technique and parameter, with defaults and ranges");
    command->add_option("NAME", *name, "Only this technique, slot or table: hbao, ao, camera, image, scene, frames");
    command->add_option("--format", *format, "text, json or markdown")
        ->check(CLI::IsMember({"text", "json", "markdown"}));
    command->callback([=, &chosen] { chosen = [=] { return run(*name, *format); }; });
}

}  // namespace limn::cli
