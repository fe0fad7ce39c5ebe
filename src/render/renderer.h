// Draws configs into pictures: loads, plans, draws every sample, reads back, and writes.
#pragma once

#include "frame/executor.h"
#include "render/loader.h"
#include "reference/ray_scene.h"
#include "render/pipeline.h"

#include <functional>
#include <memory>

namespace limn {

struct RenderedFrame;

struct RenderOptions {
    PixelRect crop;                 ///< output pixels from the *upper* left; empty: everything
    bool measure = false;
    int guard = 0;                  ///< draw at least so many pixels around the picture, and keep them in the images; even. Not of tiles
    /// Takes a picture band by band, from the top, as the layers' images, which are then forgotten. Without it the frame holds them all.
    std::function<void(const RenderedFrame&)> onBand;
};

/// Milliseconds of the parts of a frame, as seen from outside.
struct PartTime {
    std::string name;
    double milliseconds;
};

struct RenderedFrame {
    std::vector<Layer> layers;              ///< one per AOV of the config, in its order
    Metadata metadata;
    std::vector<PartTime> times;
    bool opaque = false;                    ///< the background covers everything
    std::uint64_t nonFinite = 0;            ///< values that are NaN or infinite, but for depth's background
    View view;                              ///< of the first sample
};

/// GPU milliseconds of a pass, over all samples of a frame.
struct PassTime {
    std::string name, slot;
    double milliseconds;
};

/// A plan and the pictures it would make: what `limn plan` shows.
struct ExplainedPlan {
    FramePlan frame;                        ///< of the averaged AOVs, or of everything with one sample
    std::optional<FramePlan> centre;        ///< of the AOVs taken at the pixel's centre, when there are several samples
    PlanFacts facts;
};

/// Plans a frame without GL. `maxTextureSize` is the driver's, which may change how samples are split.
ExplainedPlan planConfig(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize = 16384);

/// The device, the programs and the scenes on it, kept from frame to frame.
class Renderer {
public:
    explicit Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder = {});

    RenderedFrame render(const RenderConfig& config, const LoadedScene& loaded, int frame, const RenderOptions& options);

    /// With RenderOptions::measure: of each pass of the last frame's averaged plan, in its order.
    const std::vector<PassTime>& passTimes() const { return passTimes_; }
    /// How much of that was reading images back for passes on the CPU, and sending their results on.
    double transferMilliseconds() const { return executor_.transferMilliseconds(); }
    const gl::Device& device() const { return device_; }

private:
    /// The scene on the GPU: kept while frames differ only in what setView brings (cameras, transforms, lights). Where rays are traced, moved
    /// instances need a new tree as well.
    GpuScene& sceneOnGpu(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneData needs, std::vector<PartTime>& times);

    /// What all tiles of a frame share.
    struct Frame {
        const RenderConfig* config;
        const DrawScene* scene;
        const SceneFacts* facts;
        int number, largest;
    };
    std::vector<Image> drawTile(const Frame& frame, const PixelRect& block, const PixelRect& rect, const RenderOptions& options, RenderedFrame& result);

    gl::Device device_;
    ShaderLibrary shaders_;
    Executor executor_;
    std::vector<PassTime> passTimes_;
    std::unique_ptr<GpuScene> gpuScene_;
    std::unique_ptr<RayScene> rayScene_;     ///< only where the plan traces rays
    std::vector<glm::dmat4> places_;         ///< where instances stand, for rayScene_ and sections
    std::vector<SectionPlane> sections_;     ///< that cut what is in gpuScene_
    std::uint64_t gpuSceneNumber_ = 0;      ///< LoadedScene::number of gpuScene_
    SceneData gpuSceneData_ = SceneData::none;
    std::string gpuSceneFittedTo_;           ///< camera and picture that edges were cut for; empty when none were
};

}  // namespace limn
