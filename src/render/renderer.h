// Draws configs into pictures: loads, plans, draws every sample, reads back, and writes.
#pragma once

#include "frame/executor.h"
#include "reference/ray_scene.h"
#include "render/frame_plans.h"
#include "render/loader.h"
#include "render/scene_meshes.h"

#include <functional>
#include <future>
#include <memory>

namespace limn {

struct RenderedFrame;

struct RenderOptions {
    PixelRect crop;  ///< output pixels from the *upper* left; empty: everything
    bool measure = false;
    int guard =
        0;  ///< draw at least so many pixels around the picture, and keep them in the images; even. Not of tiles
    /// Takes a picture band by band, from the top, as the layers' images, which are then forgotten. Without it the
    /// frame holds them all.
    std::function<void(const RenderedFrame&)> onBand;
};

/// Milliseconds of the parts of a frame, as seen from outside.
struct PartTime {
    std::string name;
    double milliseconds;
};

struct RenderedFrame {
    std::vector<Layer> layers;  ///< one per AOV of the config, in its order
    Metadata metadata;
    std::vector<PartTime> times;
    bool opaque = false;          ///< the background covers everything
    std::uint64_t nonFinite = 0;  ///< values that are NaN or infinite, but for depth's background
    View view;                    ///< of the first sample
};

/// GPU milliseconds of a pass, over all samples of a frame.
struct PassTime {
    std::string name, slot;
    double milliseconds;
};

/// The device, the programs and the scenes on it, kept from frame to frame.
class Renderer {
public:
    explicit Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder = {});

    /// Meshes of the next frame that are under way: it takes them instead of making its own, if they are what it needs.
    void await(std::future<SceneMeshes> meshes) { awaited_ = std::move(meshes); }

    RenderedFrame render(
        const RenderConfig& config, const LoadedScene& loaded, int frame, const RenderOptions& options);

    /// With RenderOptions::measure: of each pass of the last frame's averaged plan, in its order.
    const std::vector<PassTime>& passTimes() const { return passTimes_; }
    /// How much of that was reading images back for passes on the CPU, and sending their results on.
    double transferMilliseconds() const { return executor_.transferMilliseconds(); }
    const gl::Device& device() const { return device_; }

private:
    /// Compiles the programs of all samples of a frame.
    void prepare(const FramePlan& frame, View view);
    /// Sees to it that the scene is on the GPU: it stays there while frames differ only in what setView brings
    /// (cameras, transforms, lights).
    void bringScene(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene,
        const SceneFacts& facts, const FramePlans& plans, std::vector<PartTime>& times);

    /// What all tiles of a frame share.
    struct Frame {
        const RenderConfig* config;
        const DrawScene* scene;
        const SceneFacts* facts;
        int number, largest;
    };
    std::vector<Image> drawTile(const Frame& frame, const PixelRect& block, const PixelRect& rect,
        const RenderOptions& options, RenderedFrame& result);

    gl::Device device_;
    ShaderLibrary shaders_;
    Executor executor_;
    std::vector<PassTime> passTimes_;
    std::unique_ptr<GpuScene> gpuScene_;
    std::unique_ptr<RayScene> rayScene_;  ///< only where the plan traces rays
    SceneKey key_;                        ///< of gpuScene_ and rayScene_
    std::future<SceneMeshes> awaited_;
};

}  // namespace limn
