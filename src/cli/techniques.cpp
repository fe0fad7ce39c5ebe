// limn techniques: every slot, technique and parameter, from the program's own tables.

#include "base/text.h"
#include "cli/commands.h"
#include "formats/scene_file.h"
#include "settings/document.h"

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
            f.info.required ? "required"
                : defaults  ? f.type().text(f.constMember(defaults))
                            : "",
            rangeText(f), std::string(f.info.unit), std::string(f.doc), f.info.accuracy,
            f.info.keyable && f.type().components > 0});
    return result;
}

/// The config's key for the technique: the output can be pasted into a config.
std::string_view keyOf(const Technique& technique) { return findSlot(technique.slot)->key; }

std::string textOf(const Technique& technique) {
    std::string out = fmt::format("{} = \"{}\"\n    {}\n", keyOf(technique), technique.name, technique.doc);
    for (const auto& row : rows(technique.schema, technique.makeParams().get())) {
        out += fmt::format("    {:<20} {}  ({}{}{}{}{})\n", row.name, row.standard, row.type,
            row.range.empty() ? "" : ", " + row.range, row.unit.empty() ? "" : ", " + row.unit,
            row.keyable ? ", may be keyed" : "", row.accuracy ? ", buys accuracy" : "");
        out += fmt::format("    {:<20} {}\n", "", row.doc);
    }
    for (const auto& preset : technique.presets)
        out += fmt::format("    {:<20} {}\n",
            preset.name == "paper" ? "mode = \"paper\"" : fmt::format("preset = \"{}\"", preset.name), preset.doc);
    return out;
}

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

ExitCode run(const std::string& name, const std::string& format) {
    std::vector<const Technique*> chosen;
    std::vector<std::string> names;
    for (const auto* technique : allTechniques()) {
        names.emplace_back(technique->name);
        if (std::find(names.begin(), names.end(), std::string(technique->slot)) == names.end())
            names.emplace_back(technique->slot);
        if (name.empty() || technique->name == name || technique->slot == name) chosen.push_back(technique);
    }
    if (chosen.empty())
        throw Error(
            ExitCode::usage, {}, fmt::format("there is no technique or slot '{}'", name), nameRemedy(name, names));
    if (format == "markdown" && name.empty()) {
        fmt::print("{}", parameterReference());
        return ExitCode::done;
    }
    if (format == "json") {
        fmt::print("{}", jsonOf(chosen));
        return ExitCode::done;
    }
    for (const auto* technique : chosen)
        fmt::print("{}", format == "markdown" ? markdownOf(*technique) : textOf(*technique) + "\n");
    return ExitCode::done;
}

}  // namespace

std::string parameterReference() {
    std::string out = "# Parameter reference\n\nMade from the program's own tables.\n\n## Render config\n\n";
    for (const auto& table : configTables())
        out += fmt::format("### {}{}\n\n{}", table.name.empty() ? "" : fmt::format("`{}`: ", table.name), table.doc,
                   markdownTable(rows(table.schema, nullptr)))
            + "\n";
    out += "## Techniques\n\n";
    for (const auto& slot : allSlots()) {
        out += fmt::format("{} Without a word about it: {}.\n\n", slot.doc,
            slot.fallback.empty() ? "nothing, at no cost" : fmt::format("`{}`", slot.fallback));
        for (const auto* technique : allTechniques())
            if (technique->slot == slot.name) out += markdownOf(*technique);
    }
    out += "## Scene file\n\n";
    for (const auto& table : sceneTables())
        out += fmt::format("### {}{}\n\n{}", table.name.empty() ? "" : fmt::format("`{}`: ", table.name), table.doc,
                   markdownTable(rows(table.schema, nullptr)))
            + "\n";
    out += "## Images (AOVs)\n\n| name | format | meaning |\n|---|---|---|\n";
    for (const Aov* aov : allAovs())
        out += fmt::format("| `{}` | {} | {} |\n", aov->name, info(aov->format).name, aov->doc);
    return out;
}

void addTechniques(CLI::App& app, Chosen& chosen) {
    auto name = std::make_shared<std::string>();
    auto format = std::make_shared<std::string>("text");
    auto* command = app.add_subcommand("techniques", "List every slot, technique and parameter");
    command->add_option("NAME", *name, "Only this technique, or this slot's");
    command->add_option("--format", *format, "text, json or markdown")
        ->check(CLI::IsMember({"text", "json", "markdown"}));
    command->callback([=, &chosen] { chosen = [=] { return run(*name, *format); }; });
}

}  // namespace limn::cli
