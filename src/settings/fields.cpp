#include "settings/fields.h"

#include "base/text.h"
#include "settings/color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace limn {
namespace {

using Problem = std::optional<std::string>;

Problem rangeProblem(double value, const Field& field) {
    if (std::isnan(value) || std::isinf(value)) return "must be a finite number";
    if (value < field.info.min || value > field.info.max)
        return fmt::format("is {}, but must be {}", numberText(value), rangeText(field));
    return {};
}

Problem expected(std::string_view wanted, const Node& node) {
    return fmt::format("must be {}, not {}", wanted, node.kindName());
}

Problem readNumbers(const Node& node, const Field& field, std::string_view wanted, std::span<double> out) {
    if (!node.isArray() || node.array().size() != out.size()) return expected(wanted, node);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!node.array()[i].isNumber()) return expected(wanted, node);
        out[i] = node.array()[i].number();
        if (auto problem = rangeProblem(out[i], field)) return problem;
    }
    return {};
}

template <class T>
Problem readScalar(void* member, const Node& node, const Field& field) {
    if (!node.isNumber()) return expected("a number", node);
    if (auto problem = rangeProblem(node.number(), field)) return problem;
    *static_cast<T*>(member) = static_cast<T>(node.number());
    return {};
}

template <class T>
std::string scalarText(const void* member) {
    return numberText(static_cast<double>(*static_cast<const T*>(member)));
}
template <class T>
void scalarToNumbers(const void* member, double* numbers) {
    numbers[0] = static_cast<double>(*static_cast<const T*>(member));
}
template <class T>
void scalarFromNumbers(void* member, const double* numbers) {
    *static_cast<T*>(member) = static_cast<T>(numbers[0]);
}
template <class T, class As = T>
void packAs(const void* member, std::byte* out) {
    const As value = static_cast<As>(*static_cast<const T*>(member));
    std::memcpy(out, &value, sizeof value);
}

Problem readInteger(void* member, const Node& node, const Field& field) {
    const auto* value = std::get_if<std::int64_t>(&node.value);
    if (!value) return expected("a whole number", node);
    if (auto problem = rangeProblem(static_cast<double>(*value), field)) return problem;
    if (std::abs(static_cast<double>(*value)) > std::numeric_limits<int>::max()) return "is too large";
    *static_cast<int*>(member) = static_cast<int>(*value);
    return {};
}

Problem readBool(void* member, const Node& node, const Field&) {
    const auto* value = std::get_if<bool>(&node.value);
    if (!value) return expected("true or false", node);
    *static_cast<bool*>(member) = *value;
    return {};
}

Problem readText(void* member, const Node& node, const Field&) {
    if (!node.text()) return expected("text", node);
    *static_cast<std::string*>(member) = *node.text();
    return {};
}

constexpr std::string_view kColorWanted = "a colour: \"#rrggbb\" or three linear numbers";

Problem readColor(void* member, const Node& node, const Field&) {
    if (const auto* hex = node.text()) {
        const auto color = parseHexColor(*hex);
        if (!color) return fmt::format("is '{}', but must be {}", *hex, kColorWanted);
        *static_cast<Color*>(member) = *color;
        return {};
    }
    if (!node.isArray() || node.array().size() != 3) return expected(kColorWanted, node);
    float* out = &static_cast<Color*>(member)->r;
    for (const auto& component : node.array()) {
        if (!component.isNumber() || !(component.number() >= 0) || !(component.number() <= 65504))
            return expected(kColorWanted, node);
        *out++ = static_cast<float>(component.number());
    }
    return {};
}

std::string colorText(const void* member) {
    const auto& color = *static_cast<const Color*>(member);
    const std::string hex = hexColor(color);
    if (parseHexColor(hex) == color) return fmt::format("\"{}\"", hex);
    return fmt::format("[{}, {}, {}]", color.r, color.g, color.b);
}

/// "12.5mm" → 12.5 and "mm"
std::optional<std::pair<double, std::string_view>> splitUnit(std::string_view text) {
    std::size_t digits = text.size();
    while (digits > 0 && (std::isalpha(static_cast<unsigned char>(text[digits - 1])) || text[digits - 1] == '%'))
        --digits;
    const auto amount = parseNumber(text.substr(0, digits));
    if (!amount) return std::nullopt;
    return std::pair(*amount, text.substr(digits));
}

constexpr std::string_view kLengthWanted = "a length: a number of scene units, or \"5%\" of the scene's diagonal";

Problem readLength(void* member, const Node& node, const Field& field) {
    Length length;
    if (node.isNumber()) {
        length = Length::units(node.number());
    } else if (const auto* text = node.text()) {
        const auto split = splitUnit(*text);
        if (!split || (split->second != "%" && !split->second.empty()))
            return fmt::format("is '{}', but must be {}", *text, kLengthWanted);
        length = split->second.empty() ? Length::units(split->first) : Length::percent(split->first);
    } else {
        return expected(kLengthWanted, node);
    }
    if (auto problem = rangeProblem(length.amount, field)) return problem;
    *static_cast<Length*>(member) = length;
    return {};
}

std::string lengthText(const void* member) {
    const auto& length = *static_cast<const Length*>(member);
    return length.relative ? fmt::format("\"{}%\"", numberText(length.amount * 100)) : numberText(length.amount);
}

constexpr std::string_view kPictureLengthWanted = "a width: \"1.5px\", \"0.35mm\" or \"0.2%\" of the image height";

Problem readPictureLength(void* member, const Node& node, const Field& field) {
    PictureLength length;
    if (node.isNumber()) {
        length.amount = node.number();
    } else if (const auto* text = node.text()) {
        const auto split = splitUnit(*text);
        using Unit = PictureLength::Unit;
        if (!split) return fmt::format("is '{}', but must be {}", *text, kPictureLengthWanted);
        length.amount = split->first;
        if (split->second == "px" || split->second.empty())
            length.unit = Unit::pixels;
        else if (split->second == "mm")
            length.unit = Unit::millimetres;
        else if (split->second == "%") {
            length.unit = Unit::imageHeight;
            length.amount /= 100;
        } else
            return fmt::format("is '{}', but must be {}", *text, kPictureLengthWanted);
    } else {
        return expected(kPictureLengthWanted, node);
    }
    if (auto problem = rangeProblem(length.amount, field)) return problem;
    *static_cast<PictureLength*>(member) = length;
    return {};
}

std::string pictureLengthText(const void* member) {
    const auto& length = *static_cast<const PictureLength*>(member);
    switch (length.unit) {
        case PictureLength::Unit::pixels: return fmt::format("\"{}px\"", numberText(length.amount));
        case PictureLength::Unit::millimetres: return fmt::format("\"{}mm\"", numberText(length.amount));
        case PictureLength::Unit::imageHeight: return fmt::format("\"{}%\"", numberText(length.amount * 100));
    }
    return {};
}

template <int N, class V>
Problem readVector(void* member, const Node& node, const Field& field) {
    constexpr std::string_view wanted[] = {
        "", "", "a list of two numbers", "a list of three numbers", "a list of four numbers"};
    std::array<double, N> numbers;
    if (auto problem = readNumbers(node, field, wanted[N], numbers)) return problem;
    if constexpr (std::is_integral_v<typename V::value_type>) {
        for (const auto& element : node.array())
            if (!std::holds_alternative<std::int64_t>(element.value)) return expected("a list of whole numbers", node);
    }
    for (int i = 0; i < N; ++i)
        (*static_cast<V*>(member))[i] = static_cast<typename V::value_type>(numbers[static_cast<std::size_t>(i)]);
    return {};
}

template <int N, class V>
std::string vectorText(const void* member) {
    std::string text;
    for (int i = 0; i < N; ++i)
        text += (i ? ", " : "[") + numberText(static_cast<double>((*static_cast<const V*>(member))[i]));
    return text + "]";
}
template <int N, class V>
void vectorToNumbers(const void* member, double* numbers) {
    for (int i = 0; i < N; ++i) numbers[i] = static_cast<double>((*static_cast<const V*>(member))[i]);
}
template <int N, class V>
void vectorFromNumbers(void* member, const double* numbers) {
    for (int i = 0; i < N; ++i) (*static_cast<V*>(member))[i] = static_cast<typename V::value_type>(numbers[i]);
}

template <class V, int N, class T>
constexpr FieldType vectorType(std::string_view name, std::string_view glsl, std::size_t align) {
    return {name, std::is_integral_v<T> ? 0 : N, readVector<N, V>, vectorText<N, V>, vectorToNumbers<N, V>,
        vectorFromNumbers<N, V>, glsl, sizeof(V), align, packAs<V>, {}};
}

/// A list of numbers of any length, such as a 4×4 matrix.
Problem readList(void* member, const Node& node, const Field& field) {
    if (!node.isArray()) return expected("a list of numbers", node);
    std::vector<double> numbers;
    for (const auto& element : node.array()) {
        // A matrix may be written as rows.
        const auto row = element.isArray() ? std::span(element.array()) : std::span(&element, 1);
        for (const auto& number : row) {
            if (!number.isNumber()) return expected("a list of numbers", number);
            if (auto problem = rangeProblem(number.number(), field)) return problem;
            numbers.push_back(number.number());
        }
    }
    *static_cast<std::vector<double>*>(member) = std::move(numbers);
    return {};
}

std::string listText(const void* member) {
    std::string text = "[";
    for (const double number : *static_cast<const std::vector<double>*>(member))
        text += (text.size() > 1 ? ", " : "") + numberText(number);
    return text + "]";
}

Problem readColorList(void* member, const Node& node, const Field& field) {
    if (!node.isArray()) return expected("a list of colours", node);
    std::vector<Color> colors;
    for (const auto& element : node.array()) {
        Color color;
        if (auto problem = readColor(&color, element, field)) return problem;
        colors.push_back(color);
    }
    *static_cast<std::vector<Color>*>(member) = std::move(colors);
    return {};
}

std::string colorListText(const void* member) {
    std::string text = "[";
    for (const auto& color : *static_cast<const std::vector<Color>*>(member))
        text += (text.size() > 1 ? ", " : "") + colorText(&color);
    return text + "]";
}

Problem readPointList(void* member, const Node& node, const Field&) {
    if (!node.isArray()) return expected("a list of points [x, y]", node);
    std::vector<glm::dvec2> points;
    for (const auto& element : node.array()) {
        if (!element.isArray() || element.array().size() != 2 || !element.array()[0].isNumber()
            || !element.array()[1].isNumber())
            return "must be a list of points, each [x, y]";
        points.emplace_back(element.array()[0].number(), element.array()[1].number());
        if (!std::isfinite(points.back().x) || !std::isfinite(points.back().y)) return "has a point that is not finite";
    }
    *static_cast<std::vector<glm::dvec2>*>(member) = std::move(points);
    return {};
}

std::string pointListText(const void* member) {
    std::string text = "[";
    for (const auto& point : *static_cast<const std::vector<glm::dvec2>*>(member))
        text += fmt::format("{}[{}, {}]", text.size() > 1 ? ", " : "", numberText(static_cast<float>(point.x)),
            numberText(static_cast<float>(point.y)));
    return text + "]";
}

std::string plain(std::string_view text) { return std::string(text); }

}  // namespace

std::optional<std::string> readEnumValue(int& value, const Node& node, std::span<const std::string_view> names) {
    std::vector<std::string> candidates(names.begin(), names.end());
    if (!node.text()) return fmt::format("must be {}", joinOr(candidates));
    const auto at = std::find(names.begin(), names.end(), *node.text());
    if (at == names.end()) return fmt::format("cannot be '{}'; {}", *node.text(), nameRemedy(*node.text(), candidates));
    value = static_cast<int>(at - names.begin());
    return {};
}

template <>
const FieldType& fieldType<float>() {
    static constexpr FieldType type{"number", 1, readScalar<float>, scalarText<float>, scalarToNumbers<float>,
        scalarFromNumbers<float>, "float", 4, 4, packAs<float>, {}};
    return type;
}
template <>
const FieldType& fieldType<double>() {
    static constexpr FieldType type{"number", 1, readScalar<double>, scalarText<double>, scalarToNumbers<double>,
        scalarFromNumbers<double>, "double", 8, 8, packAs<double>, {}};
    return type;
}
template <>
const FieldType& fieldType<int>() {
    static constexpr FieldType type{"integer", 1, readInteger, scalarText<int>, scalarToNumbers<int>,
        [](void* member, const double* numbers) {
            *static_cast<int*>(member) = static_cast<int>(std::lround(numbers[0]));
        },
        "int", 4, 4, packAs<int>, {}};
    return type;
}
template <>
const FieldType& fieldType<unsigned>() {
    static constexpr FieldType type{
        "integer", 0, nullptr, scalarText<unsigned>, nullptr, nullptr, "uint", 4, 4, packAs<unsigned>, {}};
    return type;
}
template <>
const FieldType& fieldType<bool>() {
    static constexpr FieldType type{"boolean", 1, readBool,
        [](const void* member) { return plain(*static_cast<const bool*>(member) ? "true" : "false"); },
        [](const void* member, double* numbers) { *numbers = *static_cast<const bool*>(member) ? 1 : 0; },
        [](void* member, const double* numbers) { *static_cast<bool*>(member) = *numbers >= 0.5; }, "bool", 4, 4,
        packAs<bool, int>, {}};
    return type;
}
template <>
const FieldType& fieldType<std::string>() {
    static constexpr FieldType type{"text", 0, readText,
        [](const void* member) { return fmt::format("\"{}\"", *static_cast<const std::string*>(member)); }, nullptr,
        nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<Color>() {
    static constexpr FieldType type{"colour", 3, readColor, colorText,
        [](const void* member, double* numbers) {
            for (int i = 0; i < 3; ++i) numbers[i] = (&static_cast<const Color*>(member)->r)[i];
        },
        [](void* member, const double* numbers) {
            for (int i = 0; i < 3; ++i) (&static_cast<Color*>(member)->r)[i] = static_cast<float>(numbers[i]);
        },
        "vec3", 12, 16, packAs<Color>, {}};
    return type;
}
template <>
const FieldType& fieldType<std::vector<std::string>>() {
    static constexpr FieldType type{"list of names", 0,
        [](void* member, const Node& node, const Field&) -> Problem {
            if (!node.isArray()) return expected("a list of names", node);
            std::vector<std::string> names;
            for (const auto& element : node.array()) {
                if (!element.text()) return expected("a list of names", element);
                names.push_back(*element.text());
            }
            *static_cast<std::vector<std::string>*>(member) = std::move(names);
            return {};
        },
        [](const void* member) {
            std::string text = "[";
            for (const auto& name : *static_cast<const std::vector<std::string>*>(member))
                text += fmt::format("{}\"{}\"", text.size() > 1 ? ", " : "", name);
            return text + "]";
        },
        nullptr, nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<OptionalColor>() {
    static constexpr FieldType type{"colour or \"same\"", 0,
        [](void* member, const Node& node, const Field& field) -> Problem {
            auto& optional = *static_cast<OptionalColor*>(member);
            optional.given = !node.text() || *node.text() != "same";
            return optional.given ? readColor(&optional.color, node, field) : Problem();
        },
        [](const void* member) {
            const auto& optional = *static_cast<const OptionalColor*>(member);
            return optional.given ? colorText(&optional.color) : "\"same\"";
        },
        nullptr, nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<Length>() {
    static constexpr FieldType type{"length", 1, readLength, lengthText,
        [](const void* member, double* numbers) {
            numbers[0] = static_cast<const Length*>(member)->amount,
            numbers[1] = static_cast<const Length*>(member)->relative;
        },
        [](void* member, const double* numbers) {
            *static_cast<Length*>(member) = {numbers[0], numbers[1] != 0};
        },
        "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<PictureLength>() {
    static constexpr FieldType type{"width", 1, readPictureLength, pictureLengthText,
        [](const void* member, double* numbers) {
            numbers[0] = static_cast<const PictureLength*>(member)->amount,
            numbers[1] = static_cast<double>(static_cast<const PictureLength*>(member)->unit);
        },
        [](void* member, const double* numbers) {
            *static_cast<PictureLength*>(member) = {numbers[0], static_cast<PictureLength::Unit>(numbers[1])};
        },
        "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<std::vector<double>>() {
    static constexpr FieldType type{"list of numbers", 0, readList, listText, nullptr, nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<std::vector<Color>>() {
    static constexpr FieldType type{
        "list of colours", 0, readColorList, colorListText, nullptr, nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<std::vector<glm::dvec2>>() {
    static constexpr FieldType type{
        "list of points", 0, readPointList, pointListText, nullptr, nullptr, "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<glm::dvec3>() {
    static constexpr FieldType type = [] {
        auto made = vectorType<glm::dvec3, 3, double>("three numbers", "", 0);
        made.pack = nullptr;
        return made;
    }();
    return type;
}
/// [w, x, y, z], of any length but zero.
Problem readRotation(void* member, const Node& node, const Field& field) {
    glm::dvec4 q(0);
    if (auto problem = readVector<4, glm::dvec4>(&q, node, field)) return problem;
    const double length = glm::length(q);
    if (!(length > 0) || !std::isfinite(length)) return "is no rotation: it has no length";
    q /= length;
    *static_cast<glm::dquat*>(member) = glm::dquat(q[0], q[1], q[2], q[3]);
    return {};
}

template <>
const FieldType& fieldType<glm::dquat>() {
    static constexpr FieldType type{"rotation as [w, x, y, z]", 4, readRotation,
        [](const void* member) {
            const auto& q = *static_cast<const glm::dquat*>(member);
            return fmt::format("[{}, {}, {}, {}]", numberText(q.w), numberText(q.x), numberText(q.y), numberText(q.z));
        },
        [](const void* member, double* numbers) {
            const auto& q = *static_cast<const glm::dquat*>(member);
            numbers[0] = q.w, numbers[1] = q.x, numbers[2] = q.y, numbers[3] = q.z;
        },
        [](void* member, const double* numbers) {
            const glm::dquat q(numbers[0], numbers[1], numbers[2], numbers[3]);
            const double length = glm::length(q);
            *static_cast<glm::dquat*>(member) = length > 0 ? q / length : glm::dquat(1, 0, 0, 0);
        },
        "", 0, 0, nullptr, {}};
    return type;
}
template <>
const FieldType& fieldType<glm::dvec2>() {
    static constexpr FieldType type = [] {
        auto made = vectorType<glm::dvec2, 2, double>("two numbers", "dvec2", 16);
        return made;
    }();
    return type;
}
template <>
const FieldType& fieldType<glm::ivec2>() {
    static constexpr FieldType type = vectorType<glm::ivec2, 2, int>("two integers", "ivec2", 8);
    return type;
}
template <>
const FieldType& fieldType<glm::vec2>() {
    static constexpr FieldType type = vectorType<glm::vec2, 2, float>("two numbers", "vec2", 8);
    return type;
}
template <>
const FieldType& fieldType<glm::vec3>() {
    static constexpr FieldType type = vectorType<glm::vec3, 3, float>("three numbers", "vec3", 16);
    return type;
}
template <>
const FieldType& fieldType<glm::vec4>() {
    static constexpr FieldType type = vectorType<glm::vec4, 4, float>("four numbers", "vec4", 16);
    return type;
}
template <>
const FieldType& fieldType<glm::mat4>() {
    static constexpr FieldType type{"4×4 matrix", 0, nullptr, [](const void*) { return plain("matrix"); }, nullptr,
        nullptr, "mat4", 64, 16, packAs<glm::mat4>, {}};
    return type;
}
template <>
const FieldType& fieldType<glm::dmat4>() {
    static constexpr FieldType type{"4×4 matrix", 0, nullptr, [](const void*) { return plain("matrix"); }, nullptr,
        nullptr, "dmat4", 128, 32, packAs<glm::dmat4>, {}};
    return type;
}

/// Arrays only reach shaders; no config sets them.
template <class A>
constexpr FieldType arrayType(std::string_view glsl) {
    return {"list", 0, nullptr, [](const void*) { return plain("list"); }, nullptr, nullptr, glsl, sizeof(A), 16,
        packAs<A>, {}};
}
template <>
const FieldType& fieldType<std::array<glm::vec4, 16>>() {
    static constexpr FieldType type = arrayType<std::array<glm::vec4, 16>>("vec4[16]");
    return type;
}
template <>
const FieldType& fieldType<std::array<glm::vec4, 64>>() {
    static constexpr FieldType type = arrayType<std::array<glm::vec4, 64>>("vec4[64]");
    return type;
}

template <>
const FieldType& fieldType<std::array<glm::vec4, 256>>() {
    static constexpr FieldType type = arrayType<std::array<glm::vec4, 256>>("vec4[256]");
    return type;
}

const Field* findField(Schema schema, std::string_view name) {
    for (const auto& field : schema)
        if (field.name == name) return &field;
    return nullptr;
}

std::string rangeText(const Field& field) {
    const bool below = std::isfinite(field.info.max), above = std::isfinite(field.info.min);
    if (above && below) return fmt::format("{} to {}", numberText(field.info.min), numberText(field.info.max));
    if (above) return fmt::format("at least {}", numberText(field.info.min));
    if (below) return fmt::format("at most {}", numberText(field.info.max));
    return {};
}

std::string typeText(const Field& field) {
    const auto& type = field.type();
    if (type.names.empty()) return plain(type.name);
    return "one of " + joinOr(std::vector<std::string>(type.names.begin(), type.names.end()));
}

}  // namespace limn
