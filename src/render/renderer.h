// Draws one frame: plans, uploads the scene, runs every sample, reads back.
#pragma once

#include "drawing/drawing.h"
#include "drawing/scene_lines.h"
#include "gpu/executor.h"
#include "image/image.h"
#include "rays/ray_scene.h"
#include "render/identity.h"
#include "stage/meshes.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace limn {

struct RenderedFrame;

struct RenderOptions {
    PixelRect crop;  ///< output pixels from the *upper* left; empty: everything
    bool measure = false;
    int guard = 0;  ///< draws and keeps at least this many pixels around the picture; even. Not of tiles
    /// Takes a picture band by band, from the top, as the layers' images, which it may move away. Without it
    /// the frame keeps them all.
    std::function<void(RenderedFrame&)> onBand;
    /// Told when the scene is on the GPU: what comes next may be prepared.
    std::function<void()> onScene;
    /// Told now and then how much of the picture is drawn: 0 to 1.
    std::function<void(double)> onProgress;
};

/// Wall-clock milliseconds of a part of a frame.
struct PartTime {
    std::string name;
    double milliseconds;
};

struct RenderedFrame {
    std::vector<Layer> layers;  ///< one per AOV of the config, in its order
    Metadata metadata;
    std::vector<PartTime> times;
    bool opaque = false;                     ///< the background covers everything
    std::uint64_t nonFinite = 0;             ///< values that are NaN or infinite, except depth's background
    View view;                               ///< of the first sample
    std::shared_ptr<const Drawing> drawing;  ///< where the config asks for vectors
};

struct FrameIdentity {
    Metadata metadata;  ///< of every file
    ContentKey pixels;  ///< frames with the same one show the same
};

/// GPU milliseconds of a pass, over all samples of a frame.
struct PassTime {
    std::string name, slot;
    double milliseconds;
};

/// The device with its programs and scenes, kept from frame to frame: data that stays the same is neither made nor
/// uploaded again.
class Renderer {
public:
    explicit Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder = {});

    /// Meshes under way for the next frame, which takes what it needs from them.
    void await(std::future<MadeMeshes> meshes) { awaited_ = std::move(meshes); }

    RenderedFrame render(
        const RenderConfig& config, const LoadedScene& loaded, int frame, const RenderOptions& options);

    /// The meshes that are on the GPU, and under which orders' content keys they are shown.
    struct Held {
        std::set<ContentKey> meshes;
        std::map<ContentKey, ContentKey> shownAs;
        bool contains(const ContentKey& order) const;
    };
    Held held() const;

    /// What a frame will be, without drawing it. Throws what reading its meshes throws.
    FrameIdentity identify(
        const RenderConfig& config, const LoadedScene& loaded, int frame, const PixelRect& crop) const;

    /// With RenderOptions::measure: the times of the last frame's averaged pipeline, pass by pass.
    const std::vector<PassTime>& passTimes() const { return passTimes_; }
    /// The part of these for reading images back for passes on the CPU, and sending their results on.
    double transferMilliseconds() const { return executor_.transferMilliseconds(); }
    const gl::Device& device() const { return device_; }
    /// The longest side of an image that the device takes.
    int largestTexture() const;

private:
    /// The data that all tiles of a frame share.
    struct Frame {
        const RenderConfig& config;
        const LoadedScene& loaded;
        FrameRequest request;
        SceneAt scene;
        SceneFacts facts;
        std::optional<SceneAt> previous;  ///< a frame earlier, where the plan asks
        int number;
        std::future<MadeMeshes> awaited;  ///< ends with the frame, even if that fails
        double tiles = 1, tilesDone = 0;
    };

    /// Compiles the programs of all samples of a frame.
    void prepare(const Pipeline& pipeline, View view);
    /// Uploads the scene, and makes its ray tracing tree where the plan traces rays.
    void bringScene(Frame& frame, const TilePipelines& pipelines, std::vector<PartTime>& times);
    /// The meshes that are neither on the GPU nor kept for rays.
    MadeMeshes makeMissing(
        Frame& frame, const TilePipelines& pipelines, const MeshOrders& orders, std::vector<PartTime>& times);
    /// Makes the tree anew if its input has changed; false if not.
    bool bringRays(const Frame& frame, std::span<const ContentKey> meshOf);
    /// Finds the edges of meshes that are new.
    void bringEdges(const Frame& frame, std::span<const ContentKey> meshOf);
    HostScenes hostScenes() const { return {rayScene_.get(), sceneLines_.get()}; }
    ContentKey shownAs(const ContentKey& order) const;

    /// Throws Error where the shadow maps of all lights do not fit into a texture.
    void checkShadows(const SceneAt& scene, const std::string& file) const;

    /// The lines that are drawn as vectors.
    std::shared_ptr<const Drawing> drawVectors(const Frame& frame, const View& view) const;
    /// Draws the wanted part of the picture tile by tile, and gives it on in bands.
    void drawBands(Frame& frame, const TilePipelines& pipelines, const RenderOptions& options, RenderedFrame& result);
    /// Draws a tile: one image per AOV of the config, of the tile's size (and the guard band to be kept).
    std::vector<Image> drawTile(Frame& frame, const Tile& tile, const RenderOptions& options, RenderedFrame& result);
    /// Tells RenderOptions::onProgress, at most twice a second.
    void tellProgress(const Frame& frame, const RenderOptions& options, int sample, int samples);
    /// Tells the GPU what changes with the view.
    void setView(const Frame& frame, const View& view, const ViewRequest& request);
    /// Adds to a frame's facts and content key what its samples show besides.
    static void addMoments(Frame& frame);
    /// Brings the scene at another moment of the frame.
    void moveTo(Frame& frame, const TilePipelines& pipelines, double time);
    void drawSamples(Frame& frame, const Tile& tile, const TilePipelines& pipelines, const RenderOptions& options);

    gl::Device device_;
    ShaderLibrary shaders_;
    Executor executor_;
    GpuScene gpuScene_;
    std::string shadersKey_;  ///< of a folder of shaders
    std::vector<PassTime> passTimes_;
    std::map<ContentKey, ContentKey> shownAs_;  ///< MadeMeshes::shownAs of all that was made
    std::map<ContentKey, TriMesh> hostMeshes_;  ///< only where the plan has passes on the CPU that read triangles
    std::unique_ptr<RayScene> rayScene_;        ///< only where it traces rays
    ContentKey rayKey_;                         ///< of all its input
    std::unique_ptr<SceneLines> sceneLines_;    ///< only where it draws lines from the mesh, as are:
    std::map<ContentKey, TriangleEdges> edges_;
    std::future<MadeMeshes> awaited_;
    std::chrono::steady_clock::time_point toldAt_;  ///< when RenderOptions::onProgress was told last
};

/// Makes the meshes that a frame needs and that are not held, without a device.
MadeMeshes makeMeshesOf(
    const RenderConfig& config, const LoadedScene& loaded, int frame, const Renderer::Held& held = {});

}  // namespace limn
