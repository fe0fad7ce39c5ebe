// Counts what is asked of GL, at its entry points.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace limn::test {

/// What was asked of GL.
struct Counts {
    int draws = 0, dispatches = 0, programs = 0, textures = 0, framebuffers = 0;
    std::uint64_t textureBytes = 0, bufferBytes = 0;  ///< made
    std::uint64_t uploadedBytes = 0;                  ///< handed over to buffers
};

inline Counts counts_;
inline decltype(epoxy_glDrawArrays) realDrawArrays;
inline decltype(epoxy_glMultiDrawElementsIndirect) realMultiDraw;
inline decltype(epoxy_glDispatchCompute) realDispatch;
inline decltype(epoxy_glTextureStorage2D) realTextureStorage;
inline decltype(epoxy_glNamedBufferStorage) realBufferStorage;
inline decltype(epoxy_glNamedBufferSubData) realBufferSubData;
inline decltype(epoxy_glUseProgram) realUseProgram;
inline decltype(epoxy_glCreateFramebuffers) realCreateFramebuffers;

inline std::uint64_t bytesOf(GLenum format) {
    switch (format) {
        case GL_RG32UI:
        case GL_RG32F:
        case GL_RGBA16F: return 8;
        case GL_RGBA32F: return 16;
        default: return 4;
    }
}

/// Counts while it lives. libepoxy replaces each entry point by the driver's at its first call: all that is counted
/// must have been called before.
class Counting {
public:
    Counting() {
        counts_ = {};
        realDrawArrays = epoxy_glDrawArrays;
        epoxy_glDrawArrays = [](GLenum mode, GLint first, GLsizei count) {
            ++counts_.draws;
            realDrawArrays(mode, first, count);
        };
        realMultiDraw = epoxy_glMultiDrawElementsIndirect;
        epoxy_glMultiDrawElementsIndirect = [](GLenum mode, GLenum type, const void* indirect, GLsizei count,
                                                GLsizei stride) {
            ++counts_.draws;
            realMultiDraw(mode, type, indirect, count, stride);
        };
        realDispatch = epoxy_glDispatchCompute;
        epoxy_glDispatchCompute = [](GLuint x, GLuint y, GLuint z) {
            ++counts_.dispatches;
            realDispatch(x, y, z);
        };
        realTextureStorage = epoxy_glTextureStorage2D;
        epoxy_glTextureStorage2D = [](GLuint id, GLsizei levels, GLenum format, GLsizei w, GLsizei h) {
            ++counts_.textures;
            counts_.textureBytes += bytesOf(format) * static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h);
            realTextureStorage(id, levels, format, w, h);
        };
        realBufferStorage = epoxy_glNamedBufferStorage;
        epoxy_glNamedBufferStorage = [](GLuint id, GLsizeiptr size, const void* data, GLbitfield flags) {
            counts_.bufferBytes += static_cast<std::uint64_t>(size);
            if (data) counts_.uploadedBytes += static_cast<std::uint64_t>(size);
            realBufferStorage(id, size, data, flags);
        };
        realBufferSubData = epoxy_glNamedBufferSubData;
        epoxy_glNamedBufferSubData = [](GLuint id, GLintptr offset, GLsizeiptr size, const void* data) {
            counts_.uploadedBytes += static_cast<std::uint64_t>(size);
            realBufferSubData(id, offset, size, data);
        };
        realUseProgram = epoxy_glUseProgram;
        epoxy_glUseProgram = [](GLuint id) {
            ++counts_.programs;
            realUseProgram(id);
        };
        realCreateFramebuffers = epoxy_glCreateFramebuffers;
        epoxy_glCreateFramebuffers = [](GLsizei n, GLuint* ids) {
            counts_.framebuffers += n;
            realCreateFramebuffers(n, ids);
        };
    }
    ~Counting() {
        epoxy_glDrawArrays = realDrawArrays;
        epoxy_glMultiDrawElementsIndirect = realMultiDraw;
        epoxy_glDispatchCompute = realDispatch;
        epoxy_glTextureStorage2D = realTextureStorage;
        epoxy_glNamedBufferStorage = realBufferStorage;
        epoxy_glNamedBufferSubData = realBufferSubData;
        epoxy_glUseProgram = realUseProgram;
        epoxy_glCreateFramebuffers = realCreateFramebuffers;
    }
};

inline const Counts& counts() { return counts_; }

}  // namespace limn::test
