#include "settings/uniform_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace limn {
namespace {

std::string line(const UniformBlock::Member& member) {
    return fmt::format(
        "    {} {};{}{}\n", member.type, member.name, member.comment.empty() ? "" : "  // ", member.comment);
}

std::string declaration(const UniformBlock& block, std::string_view instance) {
    std::string text = fmt::format("layout(std140, binding = {}) uniform {}Block {{\n", block.binding, block.name);
    for (const auto& member : block.members) text += line(member);
    return text + fmt::format("}} {};\n", instance);
}

bool isPartOfName(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Does the text contain `name` as a whole word?
bool mentions(std::string_view text, std::string_view name) {
    for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || !isPartOfName(text[at - 1])) && (end == text.size() || !isPartOfName(text[end]))) return true;
    }
    return false;
}

void append(UniformBlock& block, std::string_view type, std::string_view name, std::span<const std::byte> bytes) {
    const std::size_t elements = std::max<std::size_t>(1, (bytes.size() + 15) / 16), at = block.bytes.size();
    block.members.push_back({fmt::format("{}[{}]", type, elements), std::string(name), {}, elements * 16, at});
    block.bytes.resize(at + elements * 16);
    if (!bytes.empty()) std::memcpy(block.bytes.data() + at, bytes.data(), bytes.size());
}

}  // namespace

std::string UniformBlock::glsl() const { return members.empty() ? "" : declaration(*this, name); }

UniformBlock makeUniformBlock(std::string_view name, int binding, Schema schema, const void* object) {
    UniformBlock block{std::string(name), binding, {}, {}};
    for (const auto& field : schema) {
        const auto& type = field.type();
        const std::size_t at = (block.bytes.size() + type.glslAlign - 1) / type.glslAlign * type.glslAlign;
        block.bytes.resize(at + type.glslSize);
        type.pack(field.constMember(object), block.bytes.data() + at);
        block.members.push_back({std::string(type.glsl), std::string(field.name),
            fmt::format("{}{}{}", field.info.unit, field.info.unit.empty() ? "" : ": ", field.doc), type.glslSize, at});
    }
    block.bytes.resize((block.bytes.size() + 15) / 16 * 16);
    return block;
}

void appendWords(UniformBlock& block, std::string_view name, std::span<const std::uint32_t> words) {
    append(block, "uvec4", name, std::as_bytes(words));
}
void appendVectors(UniformBlock& block, std::string_view name, std::span<const glm::vec4> vectors) {
    append(block, "vec4", name, std::as_bytes(vectors));
}

HandedOn handOn(const UniformBlock& block, std::string_view fragmentSource) {
    HandedOn result;
    std::string assignments, inputs, members, arguments;
    for (const auto& member : block.members) {
        if (!mentions(fragmentSource, block.name + "." + member.name)) continue;
        // GLSL has no inputs of type bool.
        const bool isBool = member.type == "bool";
        const std::string type = isBool ? "int" : member.type, sent = block.name + "_" + member.name;
        result.vertex += fmt::format("flat out {} {};\n", type, sent);
        assignments += fmt::format("    {} = {}({}Uniforms.{});\n", sent, isBool ? "int" : "", block.name, member.name);
        inputs += fmt::format("flat in {} {};\n", type, sent);
        members += line(member);
        arguments += fmt::format("{}{}{}", arguments.empty() ? "" : ", ", sent, isBool ? " != 0" : "");
        result.vectors += static_cast<int>((member.size + 15) / 16);
    }
    if (!members.empty()) {
        result.vertex = declaration(block, block.name + "Uniforms") + result.vertex;
        result.fragment = fmt::format("{0}struct {1}Constants {{\n{2}}};\n{1}Constants {1} = {1}Constants({3});\n",
            inputs, block.name, members, arguments);
    }
    result.vertex += fmt::format("void handOn_{}() {{\n{}}}\n", block.name, assignments);
    return result;
}

}  // namespace limn
