// Constants of shaders: std140 uniform blocks, and the same numbers handed on from the vertex to the fragment shader.
#pragma once

#include "settings/fields.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// A std140 uniform block: what is in it, and its bytes. Shaders write NAME.MEMBER.
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
/// Adds a list at the end of a block: `uvec4 NAME[]`, four numbers to an element, so many elements as they take and at
/// least one.
void appendWords(UniformBlock& block, std::string_view name, std::span<const std::uint32_t> words);
/// The same: `vec4 NAME[]`.
void appendVectors(UniformBlock& block, std::string_view name, std::span<const glm::vec4> vectors);

/// The members that a fragment shader uses, as flat outputs of the vertex shader instead: GLSL for both. Software
/// renderers read a uniform anew for each pixel of a group, at ten times the price of a flat input.
struct HandedOn {
    std::string vertex;    ///< declares the block and `void handOn_NAME()`, which the vertex shader calls
    std::string fragment;  ///< declares a variable NAME with the members
    int vectors = 0;       ///< how many of the inputs of a fragment shader this takes: vectors of four
};

HandedOn handOn(const UniformBlock& block, std::string_view fragmentSource);

}  // namespace limn
