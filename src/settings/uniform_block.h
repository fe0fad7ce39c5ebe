// Constants of shaders: std140 uniform blocks, and the same numbers as flat inputs of fragment shaders.
#pragma once

#include "settings/fields.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// A std140 uniform block: its members and its bytes. Shaders write NAME.MEMBER.
struct UniformBlock {
    struct Member {
        std::string type, name;  ///< as GLSL has them: vec4[3]
        std::string comment;
        std::size_t size = 0, offset = 0;  ///< bytes
    };
    std::string name;
    int binding = 0;
    std::vector<Member> members;
    std::vector<std::byte> bytes;

    /// Its GLSL declaration.
    std::string glsl() const;
};

UniformBlock makeUniformBlock(std::string_view name, int binding, Schema schema, const void* object);
/// Adds a list at the end of a block: `uvec4 NAME[]`, four numbers per element, at least one element.
void appendWords(UniformBlock& block, std::string_view name, std::span<const std::uint32_t> words);
/// The same: `vec4 NAME[]`.
void appendVectors(UniformBlock& block, std::string_view name, std::span<const glm::vec4> vectors);

/// GLSL that hands a fragment shader the members that it uses, as flat outputs of the vertex shader. Software renderers
/// read a uniform anew for each pixel of a group, at ten times the cost of a flat input.
struct HandedOn {
    std::string vertex;    ///< declares the block and `void handOn_NAME()`, which the vertex shader calls
    std::string fragment;  ///< declares a variable NAME with the members
    int vectors = 0;       ///< inputs of a fragment shader that this takes: vectors of four
};

HandedOn handOn(const UniformBlock& block, std::string_view fragmentSource);

}  // namespace limn
