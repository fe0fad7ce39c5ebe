// A headless OpenGL 4.5 core context over EGL: no display, no window.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace limn::gl {

/// One EGL device, tried.
struct DeviceReport {
    int index = 0;
    std::string name;  ///< EGL's description before the device is tried: extension or DRM file
    std::string vendor, renderer, version;
    bool isSoftware = false;
    bool works = false;
    std::string problem;  ///< why it does not work
};

struct DeviceOptions {
    std::string device;  ///< empty: best; "software", "gpu", an index, or part of a renderer's name
    bool requireGpu = false;
    bool debug = false;  ///< KHR_debug messages are collected
    int threads = 0;     ///< of a software renderer; 0 = its own choice
};

struct Limits {
    int maxTextureSize = 0;
    int maxViewport = 0;
    int maxBufferTexels = 0;  ///< elements of one buffer texture
    int maxUniformBlock = 0;  ///< bytes
};

/// The context. It is current on the thread that made it until it is destroyed. Only one exists at a time.
class Device {
public:
    /// Tries every EGL device and keeps one that works, a GPU if possible. Throws Error (noDevice) with every device's
    /// reason.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceReport& report() const { return report_; }
    const Limits& limits() const { return limits_; }

    /// Messages of high or medium severity so far (debug only).
    const std::vector<std::string>& debugMessages() const;

    /// Throws Error when GL has reported an error since the last call: outOfMemory or internal.
    void check(const std::string& after) const;

private:
    struct State;
    std::unique_ptr<State> state_;
    DeviceReport report_;
    Limits limits_;
};

/// Tries every device, for `limn doctor`.
std::vector<DeviceReport> probeDevices();

}  // namespace limn::gl
