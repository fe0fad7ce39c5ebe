// Reads tables by their schema: single values, and keyframes where a value may move.

#include "settings/fields.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {

namespace {

/// Is this [[frame, value], ...] without the table around it?
bool looksLikeKeyframes(const Node& node) {
    const auto isPair = [](const Node& pair) {
        return pair.isArray() && pair.array().size() == 2 && pair.array()[0].isNumber();
    };
    return node.isArray() && !node.array().empty() && std::all_of(node.array().begin(), node.array().end(), isPair);
}

}  // namespace

void readFields(const Node& table, Schema schema, void* object, std::vector<Track>* tracks, std::string_view what,
    ErrorCollector& errors, std::span<const std::string_view> alsoKnown, ExitCode code) {
    if (!table.isTable()) {
        errors.add({code, table.where, fmt::format("{} must be a table, not {}", what, table.kindName()), ""});
        return;
    }
    for (const auto& [key, node] : table.table()) {
        const Field* field = findField(schema, key);
        if (!field) {
            if (std::find(alsoKnown.begin(), alsoKnown.end(), key) != alsoKnown.end()) continue;
            std::vector<std::string> candidates(alsoKnown.begin(), alsoKnown.end());
            for (const auto& known : schema) candidates.push_back(std::string(known.name));
            errors.add(
                {code, node.keyWhere, fmt::format("unknown key '{}' in {}", key, what), nameRemedy(key, candidates)});
        } else if (tracks && node.isTable()) {
            readTracks(node, *field, object, *tracks, what, errors, code);
        } else if (auto problem = field->type().read(field->member(object), node, *field)) {
            std::string remedy = std::string(field->doc);
            if (tracks && looksLikeKeyframes(node))
                remedy = "for keyframes write { keys = [[1, VALUE], [24, VALUE]] }";
            else if (!remedy.empty())
                remedy = fmt::format("{}: {}", key, remedy);
            errors.add({code, node.where, fmt::format("'{}' in {} {}", key, what, *problem), std::move(remedy)});
        }
    }
    for (const auto& field : schema)
        if (field.info.required && !table.find(field.name))
            errors.add({code, table.where, fmt::format("{} has no '{}'", what, field.name), std::string(field.doc)});
}

}  // namespace limn
