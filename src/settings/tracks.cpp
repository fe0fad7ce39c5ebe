// Values over frames: keyframes read and evaluated.

#include "settings/fields.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

constexpr std::size_t kNumbers = 4;
using Numbers = std::array<double, kNumbers>;

Numbers mix(const Numbers& a, const Numbers& b, double t) {
    Numbers value{};
    for (std::size_t i = 0; i < kNumbers; ++i) value[i] = a[i] + (b[i] - a[i]) * t;
    return value;
}

/// The change per frame at a keyframe of a curve through all of them: that of the parabola through it and its
/// neighbours.
Numbers slopeAt(const std::vector<Keyframe>& keys, std::size_t at) {
    const Keyframe& key = keys[at];
    const Keyframe &before = keys[at == 0 ? 0 : at - 1], &after = keys[std::min(at + 1, keys.size() - 1)];
    const double back = key.frame - before.frame, ahead = after.frame - key.frame;
    Numbers slope{};
    for (std::size_t i = 0; i < kNumbers; ++i) {
        const double in = back > 0 ? (key.value[i] - before.value[i]) / back : 0;
        const double out = ahead > 0 ? (after.value[i] - key.value[i]) / ahead : 0;
        slope[i] = back > 0 && ahead > 0 ? (in * ahead + out * back) / (back + ahead) : back > 0 ? in : out;
    }
    return slope;
}

/// Hermite's cubic between two keyframes, at a share t of the way.
Numbers spline(const std::vector<Keyframe>& keys, std::size_t from, double t) {
    const Keyframe &a = keys[from], &b = keys[from + 1];
    const double span = b.frame - a.frame;
    const Numbers out = slopeAt(keys, from), in = slopeAt(keys, from + 1);
    const double t2 = t * t, t3 = t2 * t;
    Numbers value{};
    for (std::size_t i = 0; i < kNumbers; ++i)
        value[i] = (2 * t3 - 3 * t2 + 1) * a.value[i] + (t3 - 2 * t2 + t) * span * out[i]
            + (3 * t2 - 2 * t3) * b.value[i] + (t3 - t2) * span * in[i];
    return value;
}

double cubic(double a, double b, double c, double d, double u) {
    const double v = 1 - u;
    return v * v * v * a + 3 * v * v * u * b + 3 * v * u * u * c + u * u * u * d;
}

/// The parameter at which a Bézier curve's frame, which never falls, is `frame`.
double parameterAt(double a, double b, double c, double d, double frame) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {  // down to the last bit
        const double middle = (low + high) / 2;
        (cubic(a, b, c, d, middle) < frame ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// A cubic Bézier curve by the handles of two keyframes. Handles that reach further than the next keyframe are
/// shortened, as Blender shortens them: time then goes forward only.
Numbers bezier(const Keyframe& a, const Keyframe& b, double frame) {
    const double span = b.frame - a.frame;
    const double out = a.right.frame - a.frame, in = b.frame - b.left.frame;
    const double ofOut = out > span ? span / out : 1, ofIn = in > span ? span / in : 1;
    const double u = parameterAt(a.frame, a.frame + ofOut * out, b.frame - ofIn * in, b.frame, frame);
    Numbers value{};
    for (std::size_t i = 0; i < kNumbers; ++i)
        value[i] = cubic(a.value[i], a.value[i] + ofOut * (a.right.value[i] - a.value[i]),
            b.value[i] + ofIn * (b.left.value[i] - b.value[i]), b.value[i], u);
    return value;
}

bool isRotation(const Track& track) { return track.component < 0 && &track.field->type() == &fieldType<glm::dquat>(); }

/// Along the shortest way around (Shoemake 1985).
Numbers slerp(const Numbers& a, const Numbers& b, double t) {
    const glm::dquat q = glm::slerp(glm::dquat(a[0], a[1], a[2], a[3]), glm::dquat(b[0], b[1], b[2], b[3]), t);
    return {q.w, q.x, q.y, q.z};
}

Numbers between(const Track& track, std::size_t from, double frame) {
    const Keyframe &a = track.keyframes[from], &b = track.keyframes[from + 1];
    double t = (frame - a.frame) / (b.frame - a.frame);
    switch (track.interpolation) {
        case Interpolation::constant: return a.value;
        case Interpolation::spline: return spline(track.keyframes, from, t);
        case Interpolation::bezier: return bezier(a, b, frame);
        case Interpolation::smooth: t = t * t * (3 - 2 * t); break;
        case Interpolation::linear: break;
    }
    return isRotation(track) ? slerp(a.value, b.value, t) : mix(a.value, b.value, t);
}

/// Within the first and the last keyframe, or at them.
Numbers within(const Track& track, double frame) {
    const auto& keys = track.keyframes;
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), frame, [](double f, const Keyframe& key) { return f < key.frame; });
    if (after == keys.begin()) return keys.front().value;
    if (after == keys.end()) return keys.back().value;
    return between(track, static_cast<std::size_t>(after - keys.begin()) - 1, frame);
}

/// The change per frame with which a track goes on beyond its end.
Numbers slopeBeyond(const Track& track, bool isBefore) {
    const auto& keys = track.keyframes;
    Numbers slope{};
    const bool byHandle = track.interpolation == Interpolation::bezier;  // the outer one, as in Blender
    if ((keys.size() < 2 && !byHandle) || track.interpolation == Interpolation::constant) return slope;
    const Keyframe& end = isBefore ? keys.front() : keys.back();
    const TrackPoint& next = byHandle ? (isBefore ? end.left : end.right)
        : isBefore                    ? static_cast<const TrackPoint&>(keys[1])
                                      : keys[keys.size() - 2];
    const double span = next.frame - end.frame;
    for (std::size_t i = 0; i < kNumbers && span != 0; ++i) slope[i] = (next.value[i] - end.value[i]) / span;
    return slope;
}

}  // namespace

std::array<double, 4> Track::at(double frame) const {
    const double first = keyframes.front().frame, last = keyframes.back().frame, span = last - first;
    const bool isBefore = frame<first, isAfter = frame> last;
    const bool isLinear = beyond == Beyond::linear;
    if ((!isBefore && !isAfter) || beyond == Beyond::hold || (!(span > 0) && !isLinear)) return within(*this, frame);
    if (isLinear) {
        const Numbers slope = slopeBeyond(*this, isBefore);
        Numbers value = (isBefore ? keyframes.front() : keyframes.back()).value;
        for (std::size_t i = 0; i < kNumbers; ++i) value[i] += slope[i] * (frame - (isBefore ? first : last));
        return value;
    }
    const double rounds = std::floor((frame - first) / span);
    double inside = frame - rounds * span;
    if (beyond == Beyond::mirror && std::fmod(std::abs(rounds), 2) == 1) inside = first + last - inside;
    Numbers value = within(*this, inside);
    if (beyond == Beyond::offset)
        for (std::size_t i = 0; i < kNumbers; ++i)
            value[i] += rounds * (keyframes.back().value[i] - keyframes.front().value[i]);
    return value;
}

void applyTracks(void* object, std::span<const Track> tracks, double frame) {
    for (const auto& track : tracks) {
        const FieldType& type = track.field->type();
        void* const member = track.field->member(object);
        Numbers value = track.at(frame);
        if (track.component >= 0) {
            const double one = value[0];
            type.toNumbers(member, value.data());
            value[static_cast<std::size_t>(track.component)] = one;
        }
        // Curves swing beyond their keys. The second number of a length is its unit.
        const bool hasUnit = &type == &fieldType<Length>() || &type == &fieldType<PictureLength>();
        for (std::size_t i = 0; i < (hasUnit ? 1 : kNumbers); ++i)
            if (value[i] < track.field->info.min || value[i] > track.field->info.max)
                value[i] = std::clamp(value[i], track.field->info.min, track.field->info.max);
        type.fromNumbers(member, value.data());
    }
}

std::string_view componentNames(const FieldType& type) {
    if (&type == &fieldType<glm::dvec3>() || &type == &fieldType<glm::vec3>()) return "xyz";
    if (&type == &fieldType<glm::dvec2>() || &type == &fieldType<glm::vec2>()) return "xy";
    if (&type == &fieldType<Color>()) return "rgb";
    if (&type == &fieldType<glm::dquat>()) return "wxyz";
    return "";
}

namespace {

constexpr auto kRemedy = "write { keys = [[1, VALUE], [24, VALUE]], interpolation = \"linear\" }";

/// Reads one track.
class TrackReader {
public:
    TrackReader(
        const Field& field, void* object, int component, std::string_view what, ErrorCollector& errors, ExitCode code)
        : field_(field), object_(object), what_(what), errors_(errors), code_(code) {
        track_.field = &field;
        track_.component = component;
    }

    std::optional<Track> read(const Node& node) {
        for (const auto& [key, entry] : node.table()) {
            if (key == "interpolation") {
                if (!readName<Interpolation>(entry, key, track_.interpolation)) return std::nullopt;
            } else if (key == "beyond") {
                if (!readName<Beyond>(entry, key, track_.beyond)) return std::nullopt;
            } else if (key != "keys") {
                return fail(entry, fmt::format("has an unknown entry '{}'", key), kRemedy);
            }
        }
        if (&field_.type() == &fieldType<bool>()) track_.interpolation = Interpolation::constant;
        const Node* keys = node.find("keys");
        if (!keys || !keys->isArray() || keys->array().empty()) return fail(node, "needs a list of keys", kRemedy);
        for (const auto& key : keys->array())
            if (!readKey(key)) return std::nullopt;
        std::stable_sort(track_.keyframes.begin(), track_.keyframes.end(),
            [](const Keyframe& a, const Keyframe& b) { return a.frame < b.frame; });
        setHandles();
        if (isRotation(track_)) turnShortWay();
        return std::move(track_);
    }

private:
    std::nullopt_t fail(const Node& at, std::string problem, std::string remedy) {
        errors_.add({code_, at.where, fmt::format("'{}' in {} {}", field_.name, what_, problem), std::move(remedy)});
        return std::nullopt;
    }

    template <class E>
    bool readName(const Node& entry, const std::string& key, E& value) {
        int choice = 0;
        if (auto problem = enumFieldType<E>().read(&choice, entry, field_))
            return fail(entry, key + " " + *problem, kRemedy), false;
        value = static_cast<E>(choice);
        return true;
    }

    /// Reads a value as the field reads it, or one of its numbers.
    bool readValue(const Node& node, Numbers& value) {
        if (track_.component >= 0) {
            if (!node.isNumber() || !std::isfinite(node.number()) || node.number() < field_.info.min
                || node.number() > field_.info.max)
                return fail(node, "has a key whose value is no number" + inRange(), ""), false;
            value[0] = node.number();
            return true;
        }
        if (auto problem = field_.type().read(field_.member(object_), node, field_))
            return fail(node, *problem, ""), false;
        field_.type().toNumbers(field_.member(object_), value.data());
        return true;
    }

    std::string inRange() const {
        const std::string range = rangeText(field_);
        return range.empty() ? "" : " (" + range + ")";
    }

    /// [frame, value], and with handles [frame, value, [frame, value], [frame, value]].
    bool readKey(const Node& node) {
        const bool hasHandles = node.isArray() && node.array().size() == 4;
        if (!node.isArray() || (node.array().size() != 2 && !hasHandles) || !isFrame(node.array()[0]))
            return fail(node, "has a key that is not [frame, value]", kRemedy), false;
        if (hasHandles && track_.interpolation != Interpolation::bezier)
            return fail(node, "has a key with handles", "they belong to interpolation = \"bezier\""), false;
        Keyframe key;
        key.frame = node.array()[0].number();
        if (!readValue(node.array()[1], key.value)) return false;
        if (hasHandles)
            if (!readHandle(node.array()[2], key.left) || !readHandle(node.array()[3], key.right)) return false;
        if (hasHandles && (key.left.frame > key.frame || key.right.frame < key.frame))
            return fail(node, "has a handle on the wrong side of its key", "the left one comes first"), false;
        hasHandle_.push_back(hasHandles);
        if (!track_.keyframes.empty() && hasHandle_.front() != hasHandles)
            return fail(node, "has handles at some keys only", "give them to all keys, or to none"), false;
        // The second number of a length is its unit: nothing lies between 2 pixels and 5 %.
        const bool hasUnit = &field_.type() == &fieldType<Length>() || &field_.type() == &fieldType<PictureLength>();
        if (hasUnit && !track_.keyframes.empty() && track_.keyframes.front().value[1] != key.value[1])
            return fail(node, "has keys in different units", "write all of them in one unit"), false;
        track_.keyframes.push_back(key);
        return true;
    }

    static bool isFrame(const Node& node) { return node.isNumber() && std::isfinite(node.number()); }

    /// A handle may lie beyond a field's range: the curve need not.
    bool readHandle(const Node& node, TrackPoint& handle) {
        const bool isPair = node.isArray() && node.array().size() == 2 && isFrame(node.array()[0]);
        if (!isPair) return fail(node, "has a handle that is not [frame, value]", kRemedy), false;
        handle.frame = node.array()[0].number();
        const Node& value = node.array()[1];
        const bool isList = value.isArray();
        const std::size_t count = track_.component >= 0 ? 1 : static_cast<std::size_t>(field_.type().components);
        if (isList ? value.array().size() != count : count != 1)
            return fail(value, fmt::format("has a handle without {} number{}", count, count == 1 ? "" : "s"), ""),
                   false;
        for (std::size_t i = 0; i < count; ++i) {
            const Node& one = isList ? value.array()[i] : value;
            if (!isFrame(one)) return fail(one, "has a handle that is no number", ""), false;
            handle.value[i] = one.number();
        }
        return true;
    }

    /// Handles that nobody gave lie along the curve through all keyframes, a third of the way.
    void setHandles() {
        if (track_.interpolation != Interpolation::bezier || hasHandle_.front()) return;
        auto& keys = track_.keyframes;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const Numbers slope = slopeAt(keys, i);
            const auto put = [&](TrackPoint& handle, double step) {
                handle.frame = keys[i].frame + step;
                for (std::size_t k = 0; k < kNumbers; ++k) handle.value[k] = keys[i].value[k] + slope[k] * step;
            };
            put(keys[i].left, i > 0 ? (keys[i - 1].frame - keys[i].frame) / 3 : -1);
            put(keys[i].right, i + 1 < keys.size() ? (keys[i + 1].frame - keys[i].frame) / 3 : 1);
        }
    }

    /// q and -q are the same rotation: the one nearer to the rotation before it.
    void turnShortWay() {
        auto& keys = track_.keyframes;
        for (std::size_t i = 1; i < keys.size(); ++i) {
            double dot = 0;
            for (std::size_t k = 0; k < kNumbers; ++k) dot += keys[i - 1].value[k] * keys[i].value[k];
            if (dot >= 0) continue;
            for (TrackPoint* point : {static_cast<TrackPoint*>(&keys[i]), &keys[i].left, &keys[i].right})
                for (double& number : point->value) number = -number;
        }
    }

    const Field& field_;
    void* object_;
    std::string_view what_;
    ErrorCollector& errors_;
    ExitCode code_;
    Track track_;
    std::vector<bool> hasHandle_;
};

}  // namespace

void readTracks(const Node& node, const Field& field, void* object, std::vector<Track>& tracks, std::string_view what,
    ErrorCollector& errors, ExitCode code) {
    const auto fail = [&](const Node& at, std::string problem, std::string remedy) {
        errors.add({code, at.where, fmt::format("'{}' in {} {}", field.name, what, problem), std::move(remedy)});
    };
    if (field.type().components == 0 || !field.info.keyable)
        return fail(node, "cannot be keyed over frames", "give it one value");
    const std::string_view names = componentNames(field.type());
    const auto isComponent = [&](const auto& entry) {
        return entry.first.size() == 1 && names.find(entry.first[0]) != std::string_view::npos;
    };
    const bool byComponent =
        !node.table().empty() && std::all_of(node.table().begin(), node.table().end(), isComponent);
    if (!byComponent) {
        if (auto track = TrackReader(field, object, -1, what, errors, code).read(node)) tracks.push_back(*track);
    } else {
        for (const auto& [name, entry] : node.table()) {
            const auto component = static_cast<int>(names.find(name[0]));
            Track still{&field, component, Interpolation::constant, Beyond::hold, {}};
            still.keyframes.resize(1);
            if (entry.isTable()) {
                if (auto track = TrackReader(field, object, component, what, errors, code).read(entry))
                    tracks.push_back(*track);
            } else if (entry.isNumber() && std::isfinite(entry.number())) {
                still.keyframes.front().value[0] = entry.number();
                tracks.push_back(still);
            } else {
                fail(entry, fmt::format("has no number for '{}'", name), kRemedy);
            }
        }
    }
    if (!tracks.empty() && tracks.back().field == &field) {
        // The object holds what the first keyframe says.
        const double first = tracks.back().keyframes.front().frame;
        for (const auto& track : tracks)
            if (track.field == &field)
                applyTracks(object, {&track, 1}, byComponent ? first : track.keyframes.front().frame);
    }
}

}  // namespace limn
