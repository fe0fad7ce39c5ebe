// Scenes and a device, kept from one picture to the next, for render, plan and study.
#pragma once

#include "render/renderer.h"
#include "render/report.h"

#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace limn {

struct SessionOptions {
    gl::DeviceOptions device;
    std::filesystem::path shaderFolder;  ///< empty: the shaders built in
};

/// Belongs to the thread that made it; loading runs on other threads.
class Session {
public:
    explicit Session(SessionOptions options = {});

    /// Begins to load the scene of a config in the background.
    void loadAhead(const RenderConfig& config);
    /// The same, and then makes the meshes of a frame (nullopt: the first declared one) for the next draw(), but those
    /// that the device holds.
    void makeAhead(const RenderConfig& config, std::optional<int> frame);
    /// The scene of a config; loads it if necessary. Throws what loading throws.
    const LoadedScene& load(const RenderConfig& config);
    /// Forgets the scene of a config and frees its memory.
    void forget(const RenderConfig& config);
    /// Forgets all scenes; or only where a file of one has changed since it was read.
    void forgetAll();
    void forgetChanged();

    /// Size and time of a file; nullopt where it is gone.
    using Stamp = std::optional<std::pair<std::uintmax_t, std::filesystem::file_time_type>>;
    static Stamp stampOf(const std::filesystem::path& file);
    /// The files of loaded scenes and their meshes as they were read.
    std::map<std::filesystem::path, Stamp> files() const;
    /// The files of loaded scenes and their meshes that have changed since.
    std::vector<std::filesystem::path> changedFiles() const;

    RenderedFrame draw(const RenderConfig& config, int frame, const RenderOptions& options = {});
    /// What a frame will be, without drawing it.
    FrameIdentity identify(const RenderConfig& config, int frame, const PixelRect& crop);
    /// Of its pixels alone.
    ContentKey pixelsKey(const RenderConfig& config, int frame);
    /// Plans without a device, unless one has been started.
    PlanReport plan(const RenderConfig& config, int frame);

    /// Ends the device: the next use starts it anew, as a new process would. References into the old one end.
    void restart() {
        meshes_ = {};
        renderer_ = nullptr;
    }
    /// Starts the device if necessary.
    Renderer& renderer();

private:
    using SceneName = std::tuple<std::string, std::optional<int>, std::optional<Axis>>;  ///< file, and MeshFileOptions
    static SceneName nameOf(const RenderConfig& config) {
        return {config.scene.string(), config.meshFile.subdivide, config.meshFile.up};
    }
    using Loading = std::shared_future<std::shared_ptr<const LoadedScene>>;

    SessionOptions options_;
    std::unique_ptr<Renderer> renderer_;
    std::map<SceneName, Loading> scenes_;
    std::map<SceneName, std::filesystem::file_time_type> begun_;  ///< when loading each began
    std::map<SceneName, std::map<std::filesystem::path, Stamp>>
        stamps_;                      ///< of the files of scenes_, when they were read
    std::future<MadeMeshes> meshes_;  ///< under way for the draw() of:
    std::optional<int> meshesFrame_;  ///< nullopt: whichever comes next
};

}  // namespace limn
