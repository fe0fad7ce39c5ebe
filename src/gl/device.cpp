#include "gl/device.h"

#include "base/error.h"
#include "base/text.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace limn::gl {
namespace {

std::string eglErrorText() {
    switch (const EGLint code = eglGetError()) {
        case EGL_SUCCESS: return "no reason given";
        case EGL_NOT_INITIALIZED: return "not initialized: no usable driver";
        case EGL_BAD_ALLOC: return "out of resources";
        case EGL_BAD_MATCH: return "no OpenGL 4.5 core context";
        case EGL_BAD_ACCESS: return "access refused";
        default: return fmt::format("EGL code 0x{:x}", code);
    }
}

std::string lower(std::string text) {
    std::transform(
        text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

const char* textOr(const char* text, const char* otherwise) { return text ? text : otherwise; }

/// A display and the device behind it.
struct Candidate {
    EGLDisplay display = EGL_NO_DISPLAY;
    DeviceReport report;
};

std::vector<Candidate> listCandidates() {
    std::vector<Candidate> candidates;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")
        || epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
        EGLint count = 0;
        eglQueryDevicesEXT(0, nullptr, &count);
        std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
        eglQueryDevicesEXT(count, devices.data(), &count);
        for (int i = 0; i < count; ++i) {
            const auto device = devices[static_cast<std::size_t>(i)];
            Candidate candidate;
            // Names may be missing inside containers: a null is no reason to give up.
            const std::string extensions = textOr(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "");
            const char* drm = extensions.find("EGL_EXT_device_drm") != std::string::npos
                ? eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT)
                : nullptr;
            candidate.report.index = i;
            candidate.report.isSoftware = extensions.find("EGL_MESA_device_software") != std::string::npos;
            candidate.report.name = candidate.report.isSoftware ? "software" : textOr(drm, "unnamed device");
            candidate.display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
            candidates.push_back(candidate);
        }
    }
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        Candidate candidate;
        candidate.report.index = static_cast<int>(candidates.size());
        candidate.report.name = "surfaceless";
        candidate.display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        candidates.push_back(candidate);
    }
    return candidates;
}

/// Makes a context on the candidate current, or reports why that fails.
EGLContext tryCandidate(Candidate& candidate, bool debug) {
    auto& report = candidate.report;
    const auto fail = [&](std::string why) {
        report.problem = std::move(why);
        return EGL_NO_CONTEXT;
    };
    if (candidate.display == EGL_NO_DISPLAY) return fail("no display");
    EGLint major = 0, minor = 0;
    if (!eglInitialize(candidate.display, &major, &minor)) return fail(eglErrorText());
    // The bound API is a property of the thread.
    if (!eglBindAPI(EGL_OPENGL_API)) return fail("no desktop OpenGL");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_CONTEXT_OPENGL_DEBUG,
        debug ? EGL_TRUE : EGL_FALSE, EGL_NONE};
    const EGLContext context = eglCreateContext(candidate.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return fail(eglErrorText());
    if (!eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        eglDestroyContext(candidate.display, context);
        return fail(eglErrorText());
    }
    const auto glText = [](GLenum name) {
        return std::string(textOr(reinterpret_cast<const char*>(glGetString(name)), ""));
    };
    report.vendor = glText(GL_VENDOR);
    report.renderer = glText(GL_RENDERER);
    report.version = glText(GL_VERSION);
    const std::string renderer = lower(report.renderer);
    report.isSoftware = renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos
        || renderer.find("swrast") != std::string::npos;
    report.works = true;
    return context;
}

void release(const Candidate& candidate, EGLContext context) {
    eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(candidate.display, context);
}

bool matches(const DeviceReport& report, const std::string& wanted) {
    if (wanted.empty()) return true;
    if (wanted == "software") return report.isSoftware;
    if (wanted == "gpu") return !report.isSoftware;
    if (const auto index = parseNumber(wanted)) return report.index == static_cast<int>(*index);
    return lower(report.renderer).find(lower(wanted)) != std::string::npos;
}

}  // namespace

struct Device::State {
    Candidate candidate;
    EGLContext context = EGL_NO_CONTEXT;
    std::vector<std::string> messages;

    ~State() {
        if (context != EGL_NO_CONTEXT) release(candidate, context);
    }

    static void onDebugMessage(
        GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text, const void* user) {
        if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
        if (type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP) return;
        static_cast<State*>(const_cast<void*>(user))->messages.emplace_back(text, static_cast<std::size_t>(length));
    }
};

Device::Device(const DeviceOptions& options) : state_(std::make_unique<State>()) {
    if (options.threads > 0) setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
    auto candidates = listCandidates();
    // GPUs first; the order is otherwise EGL's own.
    std::stable_sort(candidates.begin(), candidates.end(),
        [](const auto& a, const auto& b) { return a.report.isSoftware < b.report.isSoftware; });
    std::string reasons;
    std::vector<Candidate> softwareLater;
    const auto take = [&](Candidate& candidate, EGLContext context) {
        state_->candidate = candidate;
        state_->context = context;
        report_ = candidate.report;
    };
    const bool acceptsSoftware = !options.requireGpu && options.device != "gpu";
    for (auto& candidate : candidates) {
        const EGLContext context = tryCandidate(candidate, options.debug);
        if (context != EGL_NO_CONTEXT && matches(candidate.report, options.device)) {
            // A device that turns out to be software waits until every other one has been tried.
            if (!candidate.report.isSoftware || (acceptsSoftware && &candidate == &candidates.back())) {
                take(candidate, context);
                break;
            }
            if (acceptsSoftware) softwareLater.push_back(candidate);
        }
        if (context != EGL_NO_CONTEXT) release(candidate, context);
        const auto& r = candidate.report;
        reasons += fmt::format("\n  device {} ({}): {}", r.index, r.works ? r.renderer : r.name,
            !r.works                               ? r.problem
                : r.isSoftware && !acceptsSoftware ? "software, but a GPU was asked for"
                                                   : "not the one asked for");
    }
    if (state_->context == EGL_NO_CONTEXT && !softwareLater.empty()) {
        Candidate candidate = softwareLater.front();
        if (const EGLContext context = tryCandidate(candidate, options.debug); context != EGL_NO_CONTEXT)
            take(candidate, context);
    }
    if (state_->context == EGL_NO_CONTEXT)
        throw Error(ExitCode::noDevice, {},
            fmt::format(
                "no usable OpenGL 4.5 device{}", candidates.empty() ? ": EGL lists none" : ":" + reasons + "\n "),
            options.device.empty() && !options.requireGpu
                ? "install Mesa's drivers (libegl-mesa0, libgl1-mesa-dri) or the GPU vendor's; see limn doctor"
                : "see limn doctor for the devices of this machine");

    if (options.debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(&State::onDebugMessage, state_.get());
    }
    // Depth 0…1 as written: reversed float depth then keeps its precision.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits_.maxTextureSize);
    GLint viewport[2];
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    limits_.maxViewport = std::min(viewport[0], viewport[1]);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limits_.maxBufferTexels);
    glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &limits_.maxUniformBlock);
}

Device::~Device() = default;

const std::vector<std::string>& Device::debugMessages() const { return state_->messages; }

void Device::check(const std::string& after) const {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) return;
    while (glGetError() != GL_NO_ERROR) {}
    if (code == GL_OUT_OF_MEMORY)
        throw Error(ExitCode::outOfMemory, {}, fmt::format("the GL device ran out of memory after {}", after),
            "make the picture smaller or use fewer samples");
    throw Error(ExitCode::internal, {}, fmt::format("GL code 0x{:x} after {}", code, after), "please report this");
}

std::vector<DeviceReport> probeDevices() {
    std::vector<DeviceReport> reports;
    for (auto& candidate : listCandidates()) {
        if (const EGLContext context = tryCandidate(candidate, false); context != EGL_NO_CONTEXT)
            release(candidate, context);
        reports.push_back(candidate.report);
    }
    return reports;
}

}  // namespace limn::gl
