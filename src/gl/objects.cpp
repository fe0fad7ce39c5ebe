#include "gl/objects.h"

#include "base/error.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace limn::gl {
namespace {

GLenum internalFormat(Format format) {
    switch (format) {
        case Format::r8: return GL_R8;
        case Format::rgba8: return GL_RGBA8;
        case Format::r16f: return GL_R16F;
        case Format::r32f: return GL_R32F;
        case Format::rg32f: return GL_RG32F;
        case Format::rgba16f: return GL_RGBA16F;
        case Format::rgba32f: return GL_RGBA32F;
        case Format::r32ui: return GL_R32UI;
        case Format::rg32ui: return GL_RG32UI;
        case Format::depth32f: return GL_DEPTH_COMPONENT32F;
        case Format::srgb8Array: return GL_SRGB8_ALPHA8;
    }
    return GL_NONE;
}

void label(GLenum kind, GLuint id, const std::string& text) {
    glObjectLabel(kind, id, static_cast<GLsizei>(text.size()), text.c_str());
}

[[noreturn]] void outOfMemory(const std::string& what) {
    throw Error(ExitCode::outOfMemory, {}, fmt::format("the GL device has no memory for {}", what),
        "make the picture smaller or use fewer samples");
}

}  // namespace

void releaseBuffer(Id id) { glDeleteBuffers(1, &id); }
void releaseTexture(Id id) { glDeleteTextures(1, &id); }
void releaseFramebuffer(Id id) { glDeleteFramebuffers(1, &id); }
void releaseVertexArray(Id id) { glDeleteVertexArrays(1, &id); }
void releaseProgram(Id id) { glDeleteProgram(id); }
void releaseQuery(Id id) { glDeleteQueries(1, &id); }

static Id makeBuffer(std::size_t size, const void* data, const std::string& name, bool mappable) {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    label(GL_BUFFER, id, name);
    // GL makes no empty buffers. A buffer that is bound but never read may as well hold a word.
    constexpr std::uint32_t nothing = 0;
    const bool isEmpty = size == 0;
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(isEmpty ? sizeof nothing : size), isEmpty ? &nothing : data,
        GL_DYNAMIC_STORAGE_BIT | (mappable ? GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT : GLbitfield{0}));
    return id;
}

Buffer::Buffer(std::span<const std::byte> data, const std::string& name, bool mappable)
    : handle_(makeBuffer(data.size(), data.data(), name, mappable)), size_(data.size()) {
    if (glGetError() == GL_OUT_OF_MEMORY) outOfMemory(name);
}

Mapping::Mapping(const Buffer& buffer)
    : buffer_(buffer.id()),
      bytes_(static_cast<const std::byte*>(glMapNamedBufferRange(
          buffer_, 0, static_cast<GLsizeiptr>(buffer.size()), GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT))) {
    if (!bytes_) throw Error(ExitCode::internal, {}, "GL gives no access to a buffer's memory", "please report this");
}
Mapping::~Mapping() { glUnmapNamedBuffer(buffer_); }

Buffer Buffer::withSize(std::size_t size, const std::string& name, bool mappable) {
    Buffer buffer;
    buffer.handle_ = Handle<releaseBuffer>(makeBuffer(size, nullptr, name, mappable));
    buffer.size_ = size;
    if (glGetError() == GL_OUT_OF_MEMORY) outOfMemory(name);
    return buffer;
}

void Buffer::write(std::span<const std::byte> data, std::size_t offset) {
    if (!data.empty())
        glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
}

void Buffer::copyFrom(const Buffer& other, std::size_t bytes) {
    if (bytes > 0) glCopyNamedBufferSubData(other.id(), id(), 0, 0, static_cast<GLsizeiptr>(bytes));
}

std::vector<std::byte> Buffer::read(std::size_t offset, std::size_t bytes) const {
    std::vector<std::byte> data(bytes);
    if (bytes > 0)
        glGetNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data.data());
    return data;
}

void Buffer::bindUniform(int binding) const { glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding), id()); }

BufferView::BufferView(const Buffer& buffer, Element element, const std::string& name) {
    constexpr GLenum formats[] = {GL_R32UI, GL_RGB32UI, GL_RGBA32UI, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    handle_ = Handle<releaseTexture>(id);
    label(GL_TEXTURE, id, name);
    glTextureBuffer(id, formats[static_cast<int>(element)], buffer.id());
}
void BufferView::bind(int unit) const { glBindTextureUnit(static_cast<GLuint>(unit), handle_.get()); }

Texture::Texture(Format format, glm::ivec2 size, const std::string& name) : format_(format), size_(size) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    handle_ = Handle<releaseTexture>(id);
    label(GL_TEXTURE, id, name);
    glTextureStorage2D(id, 1, internalFormat(format), size.x, size.y);
    if (glGetError() == GL_OUT_OF_MEMORY) outOfMemory(name);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Texture Texture::pictureArray(int side, int layers, const std::string& name) {
    Texture texture;
    texture.format_ = Format::srgb8Array;
    texture.size_ = {side, side};
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
    texture.handle_ = Handle<releaseTexture>(id);
    label(GL_TEXTURE, id, name);
    glTextureStorage3D(id, 1, GL_SRGB8_ALPHA8, side, side, layers);
    if (glGetError() == GL_OUT_OF_MEMORY) outOfMemory(name);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

void Texture::writeLayer(int layer, glm::ivec2 origin, glm::ivec2 size, const std::uint8_t* rgba) const {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(id(), 0, origin.x, origin.y, layer, size.x, size.y, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

void Texture::bindSampler(int unit) const { glBindTextureUnit(static_cast<GLuint>(unit), id()); }
void Texture::bindImage(int unit, Access access) const {
    constexpr GLenum kinds[] = {GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE};
    glBindImageTexture(static_cast<GLuint>(unit), id(), 0, GL_FALSE, 0, kinds[static_cast<std::size_t>(access)],
        internalFormat(format_));
}

static std::size_t countOf(glm::ivec2 size, int channels) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(channels);
}

std::vector<float> Texture::read(int channels, glm::ivec2 origin, glm::ivec2 size) const {
    std::vector<float> pixels(countOf(size, channels));
    constexpr GLenum formats[] = {GL_NONE, GL_RED, GL_RG, GL_RGB, GL_RGBA};
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(id(), 0, origin.x, origin.y, 0, size.x, size.y, 1,
        format_ == Format::depth32f ? GL_DEPTH_COMPONENT : formats[channels], GL_FLOAT,
        static_cast<GLsizei>(pixels.size() * sizeof(float)), pixels.data());
    return pixels;
}

void Texture::write(std::span<const float> values) const {
    constexpr GLenum formats[] = {GL_NONE, GL_RED, GL_RG, GL_RGB, GL_RGBA};
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), 0, 0, 0, size_.x, size_.y, formats[info(format_).channels], GL_FLOAT, values.data());
}

void Texture::clear() const {
    constexpr GLenum formats[] = {GL_NONE, GL_RED, GL_RG, GL_RGB, GL_RGBA},
                     integers[] = {GL_NONE, GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
    const bool isInteger = info(format_).glslPrefix == "u";
    const auto channels = static_cast<std::size_t>(info(format_).channels);
    glClearTexImage(
        id(), 0, (isInteger ? integers : formats)[channels], isInteger ? GL_UNSIGNED_INT : GL_FLOAT, nullptr);
}

std::vector<std::uint32_t> Texture::readIntegers(int channels, glm::ivec2 origin, glm::ivec2 size) const {
    std::vector<std::uint32_t> pixels(countOf(size, channels));
    constexpr GLenum formats[] = {GL_NONE, GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(id(), 0, origin.x, origin.y, 0, size.x, size.y, 1, formats[channels], GL_UNSIGNED_INT,
        static_cast<GLsizei>(pixels.size() * sizeof(std::uint32_t)), pixels.data());
    return pixels;
}

Framebuffer::Framebuffer(std::span<const Texture* const> colours, const Texture* depth, const std::string& name) {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    handle_ = Handle<releaseFramebuffer>(id);
    label(GL_FRAMEBUFFER, id, name);
    std::vector<GLenum> attachments;
    for (const auto* colour : colours) {
        attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
        glNamedFramebufferTexture(id, attachments.back(), colour->id(), 0);
    }
    glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(attachments.size()), attachments.data());
    if (depth) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth->id(), 0);
    if (const GLenum status = glCheckNamedFramebufferStatus(id, GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(ExitCode::internal, {}, fmt::format("framebuffer '{}' is incomplete (0x{:x})", name, status),
            "please report this");
}

void Framebuffer::bind() const { glBindFramebuffer(GL_FRAMEBUFFER, handle_.get()); }
void Framebuffer::clearFloat(int attachment, glm::vec4 value) const {
    glClearNamedFramebufferfv(handle_.get(), GL_COLOR, attachment, &value.x);
}
void Framebuffer::clearInteger(int attachment, glm::uvec4 value) const {
    glClearNamedFramebufferuiv(handle_.get(), GL_COLOR, attachment, &value.x);
}
void Framebuffer::clearDepth(float value) const { glClearNamedFramebufferfv(handle_.get(), GL_DEPTH, 0, &value); }

VertexArray VertexArray::empty() {
    VertexArray array;
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    array.handle_ = Handle<releaseVertexArray>(id);
    return array;
}

VertexArray::VertexArray(std::span<const VertexInput> inputs, const Buffer& indices, const std::string& name) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    handle_ = Handle<releaseVertexArray>(id);
    label(GL_VERTEX_ARRAY, id, name);
    if (indices) glVertexArrayElementBuffer(id, indices.id());
    GLuint binding = 0;
    for (const auto& input : inputs) {
        const auto location = static_cast<GLuint>(input.location);
        glEnableVertexArrayAttrib(id, location);
        glVertexArrayAttribBinding(id, location, binding);
        if (input.components == 0) {
            glVertexArrayAttribIFormat(id, location, 1, GL_UNSIGNED_INT, 0);
            glVertexArrayVertexBuffer(id, binding, input.buffer->id(), 0, sizeof(std::uint32_t));
            glVertexArrayBindingDivisor(id, binding, 1);
        } else {
            glVertexArrayAttribFormat(id, location, input.components, GL_FLOAT, GL_FALSE, 0);
            glVertexArrayVertexBuffer(
                id, binding, input.buffer->id(), 0, static_cast<GLsizei>(sizeof(float)) * input.components);
        }
        ++binding;
    }
}

void VertexArray::bind() const { glBindVertexArray(handle_.get()); }

Program::Program(std::span<const ShaderStage> stages, const std::string& name) {
    handle_ = Handle<releaseProgram>(glCreateProgram());
    const GLuint id = handle_.get();
    label(GL_PROGRAM, id, name);
    const auto infoLog = [](GLuint object, auto getLength, auto getLog) {
        GLint length = 0;
        getLength(object, GL_INFO_LOG_LENGTH, &length);
        std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
        getLog(object, length, nullptr, text.data());
        text.resize(std::strlen(text.c_str()));
        return text;
    };
    for (const auto& stage : stages) {
        const GLenum kind = stage.kind == ShaderStage::Kind::vertex ? GL_VERTEX_SHADER
            : stage.kind == ShaderStage::Kind::fragment             ? GL_FRAGMENT_SHADER
                                                                    : GL_COMPUTE_SHADER;
        const GLuint shader = glCreateShader(kind);
        const char* text = stage.source.c_str();
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        GLint ok = 0;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
        const std::string log = ok ? "" : infoLog(shader, glGetShaderiv, glGetShaderInfoLog);
        glAttachShader(id, shader);
        glDeleteShader(shader);
        if (!ok)
            throw Error(ExitCode::internal, {}, fmt::format("shader '{}' does not compile:\n{}", name, log),
                "please report this, with the output of limn doctor");
    }
    glLinkProgram(id);
    GLint ok = 0;
    glGetProgramiv(id, GL_LINK_STATUS, &ok);
    if (!ok)
        throw Error(ExitCode::internal, {},
            fmt::format("shader '{}' does not link:\n{}", name, infoLog(id, glGetProgramiv, glGetProgramInfoLog)),
            "please report this, with the output of limn doctor");
}

void Program::use() const { glUseProgram(handle_.get()); }
void Program::setInt(const char* uniform, int value) const {
    glProgramUniform1i(handle_.get(), glGetUniformLocation(handle_.get(), uniform), value);
}

Timestamp::Timestamp() {
    GLuint id = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &id);
    handle_ = Handle<releaseQuery>(id);
    glQueryCounter(id, GL_TIMESTAMP);
}
double Timestamp::milliseconds() const {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(handle_.get(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-6;
}

DebugGroup::DebugGroup(const std::string& name) {
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()), name.c_str());
}
DebugGroup::~DebugGroup() { glPopDebugGroup(); }

void dispatch(glm::ivec2 size, glm::ivec2 group) {
    const glm::ivec2 groups = (size + group - 1) / group;
    glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y), 1);
    barrier();
}
void drawScreen() { glDrawArrays(GL_TRIANGLES, 0, 3); }
void drawPoints(int count, int size) {
    glPointSize(static_cast<float>(size));
    glDrawArrays(GL_POINTS, 0, count);
}
void drawElements(const Buffer& commands, int count) {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, count, sizeof(DrawCommand));
}
PushedBack::PushedBack(float pixels, float roundings, Facing facing) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-pixels, -roundings);  // nearer depths are larger
    if (facing == Facing::any) return;
    glEnable(GL_CULL_FACE);
    glCullFace(facing == Facing::front ? GL_BACK : GL_FRONT);
}
PushedBack::~PushedBack() {
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_CULL_FACE);
}

Scissor::Scissor(glm::ivec2 origin, glm::ivec2 size) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(origin.x, origin.y, size.x, size.y);
}

Scissor::~Scissor() { glDisable(GL_SCISSOR_TEST); }

void setViewport(glm::ivec2 origin, glm::ivec2 size) { glViewport(origin.x, origin.y, size.x, size.y); }
void setAdding(int colour, bool adds) {
    const auto number = static_cast<GLuint>(colour);
    if (adds) {
        glEnablei(GL_BLEND, number);
        glBlendEquationi(number, GL_FUNC_ADD);
        glBlendFunci(number, GL_ONE, GL_ONE);
    } else
        glDisablei(GL_BLEND, number);
}

void setDepthTest(DepthTest test) {
    if (test == DepthTest::none) return glDisable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
}
void barrier() { glMemoryBarrier(GL_ALL_BARRIER_BITS); }
void flush() { glFlush(); }
void finish() { glFinish(); }

}  // namespace limn::gl
