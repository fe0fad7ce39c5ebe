// Runs a Plan: makes its textures and programs, binds what each pass declared, times it if asked.
//
// Compute passes are written once and can run in two ways, to the same bits. On a GPU they are compute shaders, since
// its compute units outnumber its raster pipeline by far. On a software renderer they are one large triangle, since
// storing a pixel from a fragment shader costs a third (measured on llvmpipe: 4.6 ns against 15 ns for RGBA32F).
// Software renderers also set triangles up on one core, one after the other: in large scenes they get only the visible
// ones (gpu/culling.h).
#pragma once

#include "gl/device.h"
#include "gl/objects.h"
#include "gpu/gpu_scene.h"
#include "gpu/shaders.h"
#include "graph/graph.h"

#include <map>
#include <memory>
#include <unordered_map>

namespace limn {

class Executor {
public:
    Executor(const gl::Device& device, const ShaderLibrary& shaders) : device_(device), shaders_(shaders) {}

    /// Compiles the programs of the passes that run in the plan.
    void prepare(const Graph& graph, const Plan& plan, const View& view);

    /// Draws one sample of a frame: the passes that run in its plan. Samples must come in order. With `measure`, adds
    /// each pass's GPU time to milliseconds().
    /// `host`: see HostScenes.
    void run(
        const Graph& graph, const Plan& plan, const View& view, GpuScene& scene, const HostScenes& host, bool measure);

    /// A result of the last run that was asked for.
    const gl::Texture& texture(const Plan& plan, ResourceId resource) const;

    /// GPU milliseconds per planned pass, summed over the runs that measured.
    const std::vector<double>& milliseconds() const { return milliseconds_; }
    /// The part of these for moving images between GPU and host passes.
    double transferMilliseconds() const { return transferMilliseconds_; }
    void resetMeasurements() { milliseconds_.clear(), transferMilliseconds_ = 0; }

private:
    const gl::Program& program(
        const Graph& graph, const PlannedPass& planned, const View& view, const UniformBlock& block);
    void allocate(const Plan& plan);
    /// Do the pass's images show already what lights see?
    bool isKept(const Plan& plan, const Pass& pass, const GpuScene& scene) const;
    /// Before a pass and after it: a texture that is half written shows nothing that can be kept.
    void forgetContent(const Plan& plan, const PlannedPass& planned, const Pass& pass);
    void noteContent(const Plan& plan, const PlannedPass& planned, const Pass& pass, const GpuScene& scene);
    void runOnDevice(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view,
        const UniformBlock& block, const gl::Buffer& viewBuffer, GpuScene& scene);
    void runCompute(const Graph& graph, const Plan& plan, const PlannedPass& planned);
    void runScreen(
        const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view, const gl::Program& program);
    void runHost(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view,
        const HostScenes& host, std::span<const Mark> marks);
    bool drawsScreen() const { return device_.report().isSoftware; }
    void runRaster(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view, GpuScene& scene,
        const gl::Program& program);

    void drawSeen(const View& view, GpuScene& scene, int raster, const gl::Framebuffer& framebuffer,
        const gl::Program& program, const gl::Texture* depth);
    FarthestDepths farthestDepths(const gl::Texture& depth);

    const gl::Device& device_;
    const ShaderLibrary& shaders_;
    std::unordered_map<std::string, gl::Program> programs_;  ///< by their whole source
    std::map<std::size_t, gl::Texture> textures_;            ///< by index into Plan::textures
    /// Of textures whose content depends on nothing but what the scene's lights see: what they saw.
    std::map<std::size_t, ContentKey> seenByLights_;
    std::vector<double> milliseconds_;
    double transferMilliseconds_ = 0;
    gl::VertexArray noVertices_;
    gl::Program farthestProgram_;
    gl::Texture farthestDepths_;
    bool timerIsWarm_ = false;
};

}  // namespace limn
