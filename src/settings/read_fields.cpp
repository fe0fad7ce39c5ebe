// Reads tables by their schema: single values, and keyframes where a value may move.

#include "settings/fields.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

void applyTracks(void* object, std::span<const Track> tracks, double frame) {
    for (const auto& track : tracks) {
        const auto after = std::upper_bound(track.keyframes.begin(), track.keyframes.end(), frame,
            [](double f, const Keyframe& key) { return f < key.frame; });
        std::array<double, 4> value{};
        if (after == track.keyframes.begin()) {
            value = track.keyframes.front().value;
        } else if (after == track.keyframes.end() || track.interpolation == Interpolation::constant) {
            value = std::prev(after)->value;
        } else {
            const Keyframe& a = *std::prev(after);
            double t = (frame - a.frame) / (after->frame - a.frame);
            if (track.interpolation == Interpolation::smooth) t = t * t * (3 - 2 * t);
            for (std::size_t i = 0; i < 4; ++i) value[i] = a.value[i] + (after->value[i] - a.value[i]) * t;
        }
        track.field->type().fromNumbers(track.field->member(object), value.data());
    }
}

namespace {

/// { keys = [[frame, value], …], interpolation = "linear" }
void readTrack(const Node& node, const Field& field, void* object, std::vector<Track>& tracks, std::string_view what,
    ErrorCollector& errors, ExitCode code) {
    const auto fail = [&](const Node& at, std::string problem, std::string remedy) {
        errors.add({code, at.where, fmt::format("'{}' in {} {}", field.name, what, problem), std::move(remedy)});
    };
    constexpr auto remedy = "write { keys = [[1, VALUE], [24, VALUE]], interpolation = \"linear\" }";
    if (field.type().components == 0 || !field.info.keyable)
        return fail(node, "cannot be keyed over frames", "give it one value");
    Track track{&field, Interpolation::linear, {}};
    for (const auto& [key, entry] : node.table()) {
        if (key == "interpolation") {
            int choice = 1;
            if (auto problem = enumFieldType<Interpolation>().read(&choice, entry, field))
                return fail(entry, "interpolation " + *problem, remedy);
            track.interpolation = static_cast<Interpolation>(choice);
        } else if (key != "keys") {
            return fail(entry, fmt::format("has an unknown entry '{}'", key), remedy);
        }
    }
    const Node* keys = node.find("keys");
    if (!keys || !keys->isArray() || keys->array().empty()) return fail(node, "needs a list of keys", remedy);
    for (const auto& pair : keys->array()) {
        if (!pair.isArray() || pair.array().size() != 2 || !pair.array()[0].isNumber()
            || !std::isfinite(pair.array()[0].number()))
            return fail(pair, "has a key that is not [frame, value]", remedy);
        if (auto problem = field.type().read(field.member(object), pair.array()[1], field))
            return fail(pair, *problem, "");
        Keyframe key{pair.array()[0].number(), {}};
        field.type().toNumbers(field.member(object), key.value.data());
        // The second number of a length is its unit: nothing lies between 2 pixels and 5 %.
        const bool hasUnit = &field.type() == &fieldType<Length>() || &field.type() == &fieldType<PictureLength>();
        if (hasUnit && !track.keyframes.empty() && track.keyframes.front().value[1] != key.value[1])
            return fail(pair, "has keys in different units", "write all of them in one unit");
        track.keyframes.push_back(key);
    }
    std::stable_sort(track.keyframes.begin(), track.keyframes.end(),
        [](const Keyframe& a, const Keyframe& b) { return a.frame < b.frame; });
    field.type().fromNumbers(field.member(object), track.keyframes.front().value.data());
    tracks.push_back(std::move(track));
}

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
            readTrack(node, *field, object, *tracks, what, errors, code);
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
