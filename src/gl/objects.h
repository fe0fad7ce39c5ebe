// GL objects as move-only values: id 0 is empty, the constructor does the work and throws, the destructor releases.
// No GL name leaves this folder.
#pragma once

#include "picture/format.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn::gl {

using Id = unsigned;

/// An owned GL name and how to give it back.
template <void (*Release)(Id)>
class Handle {
public:
    Handle() = default;
    explicit Handle(Id id) : id_(id) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Handle() {
        if (id_) Release(id_);
    }
    Id get() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

private:
    Id id_ = 0;
};

void releaseBuffer(Id);
void releaseTexture(Id);
void releaseFramebuffer(Id);
void releaseVertexArray(Id);
void releaseProgram(Id);
void releaseQuery(Id);

/// How a shader accesses an image or a buffer.
enum class Access { read, write, readWrite };

class Buffer {
public:
    Buffer() = default;
    /// `mappable`: Mapping works on it; GPUs may keep such a buffer in slower memory.
    Buffer(std::span<const std::byte> data, const std::string& label, bool mappable = false);
    /// A buffer with undefined content.
    static Buffer withSize(std::size_t size, const std::string& label, bool mappable = false);
    void write(std::span<const std::byte> data, std::size_t offset = 0);
    /// The first bytes of another buffer, moved without leaving the device.
    void copyFrom(const Buffer& other, std::size_t bytes);
    std::vector<std::byte> read(std::size_t offset, std::size_t bytes) const;
    void bindUniform(int binding) const;
    std::size_t size() const { return size_; }
    Id id() const { return handle_.get(); }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    Handle<releaseBuffer> handle_;
    std::size_t size_ = 0;
};

/// Maps the bytes of a mappable buffer for reading while it lives; drawing may read them at the same time. Throws Error
/// (internal) where mapping fails.
class Mapping {
public:
    explicit Mapping(const Buffer& buffer);
    ~Mapping();
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    const std::byte* bytes() const { return bytes_; }

private:
    Id buffer_;
    const std::byte* bytes_;
};

/// The type of one fetch from a buffer texture.
enum class Element { uint1, uint3, uint4, float2, float3, float4 };

/// A buffer that shaders fetch from as a buffer texture.
class BufferView {
public:
    BufferView() = default;
    BufferView(const Buffer& buffer, Element element, const std::string& label);
    void bind(int unit) const;
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    Handle<releaseTexture> handle_;
};

/// 2D textures, one level, nearest, clamped; or an array of RGBA8 sRGB layers for pictures.
class Texture {
public:
    Texture() = default;
    Texture(Format format, glm::ivec2 size, const std::string& label);
    static Texture pictureArray(int side, int layers, const std::string& label);
    void writeLayer(int layer, glm::ivec2 origin, glm::ivec2 size, const std::uint8_t* rgba) const;

    void bindSampler(int unit) const;
    void bindImage(int unit, Access access) const;
    /// The image, or a rectangle of it, rows from the bottom as GL has them.
    std::vector<float> read(int channels) const { return read(channels, glm::ivec2(0), size_); }
    std::vector<float> read(int channels, glm::ivec2 origin, glm::ivec2 size) const;
    std::vector<std::uint32_t> readIntegers(int channels, glm::ivec2 origin, glm::ivec2 size) const;

    /// Writes the whole image, in the same order.
    void write(std::span<const float> values) const;
    void clear() const;  ///< to 0

    Format format() const { return format_; }
    glm::ivec2 size() const { return size_; }
    Id id() const { return handle_.get(); }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    Handle<releaseTexture> handle_;
    Format format_ = Format::r32f;
    glm::ivec2 size_{0};
};

/// Colour attachments in order, and depth.
class Framebuffer {
public:
    Framebuffer() = default;
    Framebuffer(std::span<const Texture* const> colours, const Texture* depth, const std::string& label);
    void bind() const;
    void clearFloat(int attachment, glm::vec4 value) const;
    void clearInteger(int attachment, glm::uvec4 value) const;
    void clearDepth(float value) const;

private:
    Handle<releaseFramebuffer> handle_;
};

struct VertexInput {
    const Buffer* buffer;
    int location;
    int components;  ///< floats; 0 = one unsigned integer per instance
};

class VertexArray {
public:
    VertexArray() = default;
    VertexArray(std::span<const VertexInput> inputs, const Buffer& indices,
        const std::string& label);  ///< `indices` may be empty
    /// For draws whose shaders generate the vertices.
    static VertexArray empty();
    void bind() const;
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    Handle<releaseVertexArray> handle_;
};

struct ShaderStage {
    enum class Kind { vertex, fragment, compute };
    Kind kind;
    std::string source;
};

class Program {
public:
    Program() = default;
    /// Throws Error (internal) with the compiler's message.
    Program(std::span<const ShaderStage> stages, const std::string& label);
    void use() const;
    explicit operator bool() const { return static_cast<bool>(handle_); }
    void setInt(const char* uniform, int value) const;

private:
    Handle<releaseProgram> handle_;
};

/// The GPU's clock, at the point of the command stream where this was made.
class Timestamp {
public:
    Timestamp();
    double milliseconds() const;  ///< waits for the result

private:
    Handle<releaseQuery> handle_;
};

/// Names everything drawn in its lifetime, for debuggers.
class DebugGroup {
public:
    explicit DebugGroup(const std::string& name);
    ~DebugGroup();
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

/// The record of glDrawElementsIndirect.
struct DrawCommand {
    std::uint32_t count, instanceCount, firstIndex;
    std::int32_t baseVertex;
    std::uint32_t baseInstance;
};

enum class DepthTest { none, greater };

/// Triangles by the side that they turn to the eye.
enum class Facing { any, front, back };

/// Moves what is drawn away from the eye while this lives: by how much its depth changes over `pixels`, and by
/// `roundings` of the depth buffer. Draws only what faces the eye so.
class PushedBack {
public:
    PushedBack(float pixels, float roundings, Facing facing);
    ~PushedBack();
    PushedBack(const PushedBack&) = delete;
    PushedBack& operator=(const PushedBack&) = delete;
};

/// Drawing touches nothing outside a rectangle while this lives.
class Scissor {
public:
    Scissor(glm::ivec2 origin, glm::ivec2 size);
    ~Scissor();
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;
};

void dispatch(glm::ivec2 size, glm::ivec2 group);      ///< enough groups to cover the size, then a barrier
void drawScreen();                                     ///< the three vertices of shaders/gpu/screen.vert
void drawPoints(int count, int size);                  ///< squares of so many pixels
void drawElements(const Buffer& commands, int count);  ///< indirect, 32-bit indices
void setViewport(glm::ivec2 origin, glm::ivec2 size);
void setDepthTest(DepthTest test);
/// Adds draws to a framebuffer's colour image, or replaces its content.
void setAdding(int colour, bool adds);
void barrier();
void flush();  ///< lets the device begin with what it has been given
void finish();

}  // namespace limn::gl
