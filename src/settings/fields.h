// Parameters, declared once.
//
// A settings struct has a table of Fields beside it; the default of a parameter is its member initializer. That one
// table gives: reading from a config, range and type errors, "did you mean", --set, the text of `limn techniques`, the
// parameter reference, keyframes, the GLSL uniform block with its std140 packing, and the axes a study may sweep.
//
//     struct Params { float radius = 0.5f; int directions = 6; };
//     constexpr Field kParams[] = {
//         field<&Params::radius>("radius", {.unit = "scene units", .min = 0}, "Farthest occluder that darkens a
//         point."),
//         field<&Params::directions>("directions", {.min = 1, .max = 64, .accuracy = true}, "Search directions per
//         pixel."),
//     };
#pragma once

#include "settings/node.h"
#include "settings/values.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace limn {

/// The names of an enumeration, in the order of its values from 0. Specialize beside the enum.
template <class E>
inline constexpr std::array<std::string_view, 0> enumNames{};

/// What is declared about a parameter besides its type and default.
struct FieldInfo {
    std::string_view unit;
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool accuracy = false;  ///< buys accuracy with time: a study may sweep it
    bool required = false;  ///< has no default
    bool keyable = true;    ///< may have keyframes, where its type can be interpolated
};

struct Field;

/// Everything the tables need to know about a member's type.
struct FieldType {
    std::string_view name;  ///< as people call it: "number", "colour" ...
    int components;         ///< numbers in a keyframe; 0 = cannot have keyframes
    /// Reads a node into the member. Returns what is wrong, in words that follow "NAME ", or nothing.
    std::optional<std::string> (*read)(void* member, const Node& node, const Field& field);
    std::string (*text)(const void* member);  ///< as it would be written in TOML
    void (*toNumbers)(const void* member, double* numbers);
    void (*fromNumbers)(void* member, const double* numbers);
    std::string_view glsl;            ///< type in a uniform block; empty = never reaches a shader
    std::size_t glslSize, glslAlign;  ///< std140
    void (*pack)(const void* member, std::byte* out);
    std::span<const std::string_view> names;  ///< of an enumeration
};

/// Declared for float, double, int, bool, text, Color, Length, PictureLength, vectors, rotations, lists and every enum
/// with enumNames.
template <class T>
const FieldType& fieldType();

/// Finds an enumeration's value by name; returns what is wrong, or nothing.
std::optional<std::string> readEnumValue(int& value, const Node& node, std::span<const std::string_view> names);

template <class E>
requires std::is_enum_v<E>
const FieldType& enumFieldType() {
    static_assert(enumNames<E>.size() > 0, "specialize enumNames beside the enum");
    static_assert(sizeof(E) == sizeof(int));
    static constexpr FieldType type{"name", 0,
        [](void* member, const Node& node, const Field&) {
            return readEnumValue(*static_cast<int*>(member), node, enumNames<E>);
        },
        [](const void* member) {
            return '"' + std::string(enumNames<E>[static_cast<std::size_t>(*static_cast<const int*>(member))]) + '"';
        },
        nullptr, nullptr, "int", 4, 4, [](const void* member, std::byte* out) { std::memcpy(out, member, 4); },
        enumNames<E>};
    return type;
}

struct Field {
    std::string_view name;
    FieldInfo info;
    std::string_view doc;
    const FieldType& (*type)() = nullptr;
    void* (*member)(void* object) = nullptr;

    const void* constMember(const void* object) const { return member(const_cast<void*>(object)); }
};

template <class M>
struct MemberOf;
template <class S, class T>
struct MemberOf<T S::*> {
    using Struct = S;
    using Type = T;
};

template <auto Member>
constexpr Field field(std::string_view name, FieldInfo info, std::string_view doc) {
    using Traits = MemberOf<decltype(Member)>;
    constexpr auto type = [] {
        if constexpr (std::is_enum_v<typename Traits::Type>)
            return &enumFieldType<typename Traits::Type>;
        else
            return &fieldType<typename Traits::Type>;
    }();
    return {name, info, doc, type,
        [](void* object) -> void* { return &(static_cast<typename Traits::Struct*>(object)->*Member); }};
}
template <auto Member>
constexpr Field field(std::string_view name, std::string_view doc) {
    return field<Member>(name, FieldInfo{}, doc);
}

/// A field that is an element of an array member.
template <auto Member, std::size_t I>
constexpr Field elementField(std::string_view name, FieldInfo info, std::string_view doc) {
    using Traits = MemberOf<decltype(Member)>;
    using Element = typename Traits::Type::value_type;
    constexpr auto type = [] {
        if constexpr (std::is_enum_v<Element>)
            return &enumFieldType<Element>;
        else
            return &fieldType<Element>;
    }();
    return {name, info, doc, type,
        [](void* object) -> void* { return &(static_cast<typename Traits::Struct*>(object)->*Member)[I]; }};
}

/// Joins tables into one.
template <std::size_t... N>
constexpr auto joinFields(const std::array<Field, N>&... tables) {
    std::array<Field, (N + ...)> all{};
    std::size_t at = 0;
    const auto append = [&](const auto& table) {
        for (const auto& field : table) all[at++] = field;
    };
    (append(tables), ...);
    return all;
}

using Schema = std::span<const Field>;

const Field* findField(Schema schema, std::string_view name);

/// "0 to 1", "at least 0", or "" for a field without bounds.
std::string rangeText(const Field& field);
/// What may be written: "number", "integer", "one of a, b" ...
std::string typeText(const Field& field);

// --- Values over frames

/// Between two keyframes: the first one's value; straight; slow at both ends; a curve through all keyframes without
/// corners (Catmull & Rom 1974, for uneven distances); a cubic Bézier curve by handles, as animation programs have it.
enum class Interpolation { constant, linear, smooth, spline, bezier };
template <>
inline constexpr std::array<std::string_view, 5> enumNames<Interpolation> = {
    "constant", "linear", "smooth", "spline", "bezier"};

/// Before the first keyframe and after the last: their values; straight on; all again; again, moved on by what a round
/// brings; again, there and back.
enum class Beyond { hold, linear, repeat, offset, mirror };
template <>
inline constexpr std::array<std::string_view, 5> enumNames<Beyond> = {"hold", "linear", "repeat", "offset", "mirror"};

/// A frame and a value there.
struct TrackPoint {
    double frame = 0;
    std::array<double, 4> value{};
};

struct Keyframe : TrackPoint {
    TrackPoint left, right;  ///< handles; only of Bézier curves
};

/// The keyframes of one field, sorted by frame, or those of one of its numbers.
struct Track {
    const Field* field = nullptr;
    int component = -1;  ///< -1: all numbers; else one, in the first of each value
    Interpolation interpolation = Interpolation::linear;
    Beyond beyond = Beyond::hold;
    std::vector<Keyframe> keyframes;

    /// The numbers at a frame.
    std::array<double, 4> at(double frame) const;
};

/// Reads `{ keys = [[frame, value], …], interpolation = …, beyond = … }`, or one such table for each of a field's
/// numbers, by the names of componentNames(). The object then holds the first keyframe's value. Adds problems to
/// `errors`.
void readTracks(const Node& node, const Field& field, void* object, std::vector<Track>& tracks, std::string_view what,
    ErrorCollector& errors, ExitCode code);

/// What the numbers of a field are called: "xyz", "rgb", "wxyz"; empty for single numbers.
std::string_view componentNames(const FieldType& type);

/// Writes the tracks' values at `frame` into the object.
void applyTracks(void* object, std::span<const Track> tracks, double frame);

/// A settings struct whose fields may have keyframes.
template <class T>
struct Keyed {
    T base{};
    std::vector<Track> tracks;

    T at(double frame) const {
        T value = base;
        applyTracks(&value, tracks, frame);
        return value;
    }
    bool moves() const { return !tracks.empty(); }
};

/// A table of a config or scene file, for the parameter reference.
struct SettingsTable {
    std::string_view name;  ///< "[[camera]]", or "[[light]] shadow" within another; empty: the top of the file
    std::string_view doc;
    Schema schema;
    const void* defaults;  ///< an object with the schema's defaults
};

/// An object that nothing has been said about.
template <class T>
const void* defaultsOf() {
    static const T instance{};
    return &instance;
}

// --- Reading

/// Reads the entries of `table` that `schema` names into `object`. Keyframes go to `tracks`; the object then holds the
/// first keyframe's value. Adds every problem to `errors`, with place and remedy: unknown keys too, except those in
/// `alsoKnown`. `what` names the table in messages: "[ao]", "[[light]]".
void readFields(const Node& table, Schema schema, void* object, std::vector<Track>* tracks, std::string_view what,
    ErrorCollector& errors, std::span<const std::string_view> alsoKnown = {}, ExitCode code = ExitCode::usage);

}  // namespace limn
