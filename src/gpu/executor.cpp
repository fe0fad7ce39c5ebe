#include "gpu/executor.h"

#include "base/heap.h"
#include "gpu/pass_shaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <optional>

namespace limn {

const gl::Program& Executor::program(
    const Graph& graph, const PlannedPass& planned, const View& view, const UniformBlock& block) {
    const auto stages =
        shadersOf(graph, planned, view, block, drawsScreen() ? ComputeAs::fragments : ComputeAs::workGroups, shaders_);
    std::string key;
    for (const auto& stage : stages) key += stage.source;
    auto it = programs_.find(key);
    if (it == programs_.end())
        it = programs_.emplace(key, gl::Program(stages, graph.passes[static_cast<std::size_t>(planned.pass)].name))
                 .first;
    return it->second;
}

void Executor::prepare(const Graph& graph, const Plan& plan, const View& view) {
    const UniformBlock block = viewBlock(view);
    for (const auto& planned : plan.passes)
        if (planned.runs && graph.passes[static_cast<std::size_t>(planned.pass)].kind != Pass::Kind::host)
            program(graph, planned, view, block);
}

void Executor::allocate(const Plan& plan) {
    textures_.erase(textures_.lower_bound(plan.textures.size()), textures_.end());
    seenByLights_.erase(seenByLights_.lower_bound(plan.textures.size()), seenByLights_.end());
    std::vector<std::size_t> missing;
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < plan.textures.size(); ++i) {
        const auto& wanted = plan.textures[i];
        auto& texture = textures_[i];
        if (texture && texture.format() == wanted.format && texture.size() == wanted.size) continue;
        seenByLights_.erase(i);
        texture = {};  // frees the old texture before any new one is made
        missing.push_back(i);
        bytes += wanted.bytes();
    }
    // llvmpipe takes images from the C heap. The extra third is for triangles and for images that are read back.
    if (device_.report().isSoftware) bringInPages(bytes + bytes / 3);
    for (const std::size_t i : missing)
        textures_[i] = gl::Texture(plan.textures[i].format, plan.textures[i].size, fmt::format("texture {}", i));
}

/// Index into Plan::textures.
static std::size_t textureOf(const Plan& plan, ResourceId resource) {
    return static_cast<std::size_t>(plan.textureOf[static_cast<std::size_t>(resource.index)]);
}

bool Executor::isKept(const Plan& plan, const Pass& pass, const GpuScene& scene) const {
    return pass.isOfLights && std::all_of(pass.writes.begin(), pass.writes.end(), [&](const Write& write) {
        const auto seen = seenByLights_.find(textureOf(plan, write.resource));
        return seen != seenByLights_.end() && seen->second == scene.shadowsKey();
    });
}

void Executor::forgetContent(const Plan& plan, const PlannedPass& planned, const Pass& pass) {
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) seenByLights_.erase(textureOf(plan, pass.writes[w].resource));
}

void Executor::noteContent(const Plan& plan, const PlannedPass& planned, const Pass& pass, const GpuScene& scene) {
    if (!pass.isOfLights) return;
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) seenByLights_[textureOf(plan, pass.writes[w].resource)] = scene.shadowsKey();
}

const gl::Texture& Executor::texture(const Plan& plan, ResourceId resource) const {
    return textures_.at(textureOf(plan, resource));
}

void Executor::run(
    const Graph& graph, const Plan& plan, const View& view, GpuScene& scene, const HostScenes& host, bool measure) {
    allocate(plan);
    const UniformBlock block = viewBlock(view);
    const gl::Buffer viewBuffer(block.bytes, "view");
    std::vector<gl::Timestamp> stamps;
    const auto stamp = [&] {
        if (!measure) return;
        gl::finish();  // a pass's time must not include earlier work
        stamps.emplace_back();
    };
    if (measure && !timerIsWarm_) {
        // The first timer query of a process gives garbage on llvmpipe: let it measure nothing.
        static_cast<void>(gl::Timestamp().milliseconds());
        timerIsWarm_ = true;
    }
    stamp();
    for (const auto& planned : plan.passes) {
        const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
        if (planned.runs && !isKept(plan, pass, scene)) {
            const gl::DebugGroup group(pass.name);
            forgetContent(plan, planned, pass);
            if (pass.kind == Pass::Kind::host)
                runHost(graph, plan, planned, view, host, scene.marks());
            else
                runOnDevice(graph, plan, planned, view, block, viewBuffer, scene);
            noteContent(plan, planned, pass, scene);
        }
        stamp();
    }
    if (measure) {
        milliseconds_.resize(plan.passes.size());
        for (std::size_t i = 0; i < plan.passes.size(); ++i)
            milliseconds_[i] += stamps[i + 1].milliseconds() - stamps[i].milliseconds();
    }
    device_.check("drawing");
}

void Executor::runOnDevice(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view,
    const UniformBlock& block, const gl::Buffer& viewBuffer, GpuScene& scene) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    const gl::Program& linked = program(graph, planned, view, block);
    linked.use();
    viewBuffer.bindUniform(0);
    std::optional<gl::Buffer> params;
    if (!pass.params.bytes.empty()) params.emplace(pass.params.bytes, pass.name + " params").bindUniform(1);
    scene.bind();
    const bool asImages = pass.kind == Pass::Kind::compute && drawsScreen();
    int unit = 0;
    for (const auto& read : pass.reads) {
        const auto& image = texture(plan, read.resource);
        if (asImages && !info(image.format()).glslImage.empty())
            image.bindImage(unit++, gl::Access::read);
        else
            image.bindSampler(unit++);
    }
    if (pass.kind == Pass::Kind::raster)
        runRaster(graph, plan, planned, view, scene, linked);
    else if (drawsScreen())
        runScreen(graph, plan, planned, view, linked);
    else
        runCompute(graph, plan, planned);
}

/// The part of an image that a pass must make: the picture and the pass's halo. Images may be coarser than the region
/// drawn.
static PixelRect neededPart(const PlannedPass& planned, const View& view, glm::ivec2 imageSize) {
    const int coarse = std::max(1, (view.region.size.x + imageSize.x - 1) / imageSize.x);
    const int skipped = planned.whole ? 0 : std::max(0, view.guard - planned.halo);
    const glm::ivec2 first(skipped / coarse), last = (view.region.size - skipped + coarse - 1) / coarse;
    return {first, glm::min(last, imageSize) - first};
}

void Executor::runCompute(const Graph& graph, const Plan& plan, const PlannedPass& planned) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    glm::ivec2 size(0);
    int unit = 0;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        if (!planned.writes[w]) continue;
        const auto& image = texture(plan, pass.writes[w].resource);
        if (pass.mask >= 0) image.clear();
        image.bindImage(unit++, pass.writes[w].sums ? gl::Access::readWrite : gl::Access::write);
        size = glm::max(size, image.size());
    }
    gl::dispatch(size, kWorkGroup);
}

void Executor::runHost(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view,
    const HostScenes& host, std::span<const Mark> marks) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    if (has(pass.needs, SceneData::marks) && marks.empty()) {
        for (std::size_t w = 0; w < pass.writes.size(); ++w)
            if (planned.writes[w]) texture(plan, pass.writes[w].resource).clear();
        return;
    }
    HostWork work{&view, host, marks, {}, {}, neededPart(planned, view, view.region.size)};
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& read : pass.reads) {
        const auto& image = texture(plan, read.resource);
        const int channels = info(image.format()).channels;
        work.reads.push_back({image.size(), channels, image.read(channels)});
    }
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        HostImage& image = work.writes.emplace_back();
        if (!planned.writes[w]) continue;
        const auto& target = texture(plan, pass.writes[w].resource);
        image = {target.size(), info(target.format()).channels, {}};
        image.values.resize(static_cast<std::size_t>(image.size.x) * static_cast<std::size_t>(image.size.y)
            * static_cast<std::size_t>(image.channels));
    }
    const auto worked = std::chrono::steady_clock::now();
    pass.work(work);
    const auto done = std::chrono::steady_clock::now();
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) texture(plan, pass.writes[w].resource).write(work.writes[w].values);
    gl::finish();
    transferMilliseconds_ +=
        std::chrono::duration<double, std::milli>((worked - begin) + (std::chrono::steady_clock::now() - done)).count();
}

/// The middles of the tiles in a mask, as points; counted in tiles.
static std::vector<float> maskedTiles(const gl::Texture& mask) {
    const auto values = mask.read(1);
    std::vector<float> tiles;
    for (int y = 0; y < mask.size().y; ++y)
        for (int x = 0; x < mask.size().x; ++x)
            if (values[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.size().x)
                    + static_cast<std::size_t>(x)]
                > 0)
                tiles.insert(tiles.end(), {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
    return tiles;
}

void Executor::runScreen(
    const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view, const gl::Program& linked) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    std::vector<const gl::Texture*> colours;
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) colours.push_back(&texture(plan, pass.writes[w].resource));
    const gl::Framebuffer framebuffer(colours, nullptr, pass.name);
    framebuffer.bind();
    gl::setDepthTest(gl::DepthTest::none);
    gl::setViewport({0, 0}, colours.front()->size());
    const PixelRect part = neededPart(planned, view, colours.front()->size());
    int colour = 0;
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) gl::setAdding(colour++, pass.writes[w].sums && view.sample > 0);
    if (pass.mask >= 0) {
        for (const auto* image : colours) image->clear();
        const auto& mask = texture(plan, pass.reads[static_cast<std::size_t>(pass.mask)].resource);
        const auto tiles = maskedTiles(mask);
        // Whole tiles, so that no tile's middle lies outside.
        gl::setViewport({0, 0}, mask.size() * kMaskTile);
        linked.setInt("tilesX", mask.size().x);
        linked.setInt("tilesY", mask.size().y);
        const gl::Buffer buffer(std::as_bytes(std::span(tiles)), "tiles");
        const gl::VertexInput input{&buffer, 0, 2};
        const gl::VertexArray points({&input, 1}, {}, "tiles");
        points.bind();
        const gl::Scissor scissor(part.origin, part.size);
        if (!tiles.empty()) gl::drawPoints(static_cast<int>(tiles.size() / 2), kMaskTile);
    } else {
        if (!noVertices_) noVertices_ = gl::VertexArray::empty();
        noVertices_.bind();
        const gl::Scissor scissor(part.origin, part.size);
        gl::drawScreen();
    }
    while (colour > 0) gl::setAdding(--colour, false);
    gl::barrier();
}

/// Draws what the picture's camera sees: first the triangles that face it, then the others that those do not hide.
void Executor::drawSeen(const View& view, GpuScene& scene, int raster, const gl::Framebuffer& framebuffer,
    const gl::Program& linked, const gl::Texture* depth) {
    const auto draw = [&](auto&& what) {
        framebuffer.bind();
        linked.use();
        gl::setDepthTest(depth ? gl::DepthTest::greater : gl::DepthTest::none);
        gl::setViewport({0, 0}, view.canvas.size * raster);
        // Only the region matters, even if the canvas is larger.
        const gl::Scissor scissor((view.region.origin - view.canvas.origin) * raster, view.region.size * raster);
        what();
    };
    if (!depth) return draw([&] { scene.draw(); });
    if (!scene.isCullable()) {
        draw([&] { scene.drawAlone(); });
    } else {
        draw([&] { scene.drawSeen(nullptr); });
        const FarthestDepths farthest = farthestDepths(*depth);
        draw([&] { scene.drawSeen(&farthest); });
    }
    draw([&] { scene.drawCoincident(); });
}

FarthestDepths Executor::farthestDepths(const gl::Texture& depth) {
    FarthestDepths farthest;
    farthest.size = (depth.size() + farthest.side - 1) / farthest.side;
    const gl::DebugGroup group("farthest_depths");
    if (!farthestDepths_ || farthestDepths_.size() != farthest.size) {
        farthestDepths_ = {};
        farthestDepths_ = gl::Texture(Format::r32f, farthest.size, "farthest depths");
    }
    if (!farthestProgram_)
        farthestProgram_ = gl::Program(std::vector<gl::ShaderStage>{{gl::ShaderStage::Kind::vertex,
                                                                        "#version 450 core\nvoid handOn() {}\n"
                                                                            + shaders_.load("gpu/screen.vert")},
                                           {gl::ShaderStage::Kind::fragment,
                                               fmt::format("#version 450 core\n#define SIDE {}\n", farthest.side)
                                                   + shaders_.load("gpu/farthest_depths.frag")}},
            "farthest_depths");
    const gl::Texture* target = &farthestDepths_;
    const gl::Framebuffer framebuffer({&target, 1}, nullptr, "farthest_depths");
    framebuffer.bind();
    farthestProgram_.use();
    gl::setDepthTest(gl::DepthTest::none);
    gl::setViewport({0, 0}, farthest.size);
    depth.bindSampler(0);
    if (!noVertices_) noVertices_ = gl::VertexArray::empty();
    noVertices_.bind();
    gl::drawScreen();
    gl::barrier();
    farthest.values = farthestDepths_.read(1);
    return farthest;
}

void Executor::runRaster(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view,
    GpuScene& scene, const gl::Program& linked) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    std::vector<const gl::Texture*> colours;
    std::vector<glm::vec4> clears;
    const gl::Texture* depth = nullptr;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        if (!planned.writes[w]) continue;
        const auto& image = texture(plan, pass.writes[w].resource);
        if (image.format() == Format::depth32f)
            depth = &image;
        else {
            colours.push_back(&image);
            clears.push_back(pass.writes[w].clear);
        }
    }
    const gl::Framebuffer framebuffer(colours, depth, pass.name);
    framebuffer.bind();
    for (std::size_t i = 0; i < colours.size(); ++i) {
        if (info(colours[i]->format()).glslPrefix == "u")
            framebuffer.clearInteger(static_cast<int>(i), glm::uvec4(clears[i]));
        else
            framebuffer.clearFloat(static_cast<int>(i), clears[i]);
    }
    if (depth) framebuffer.clearDepth(0);
    gl::setDepthTest(depth ? gl::DepthTest::greater : gl::DepthTest::none);
    if (pass.rasterViews.empty()) {
        // The images are on the fine raster or on the picture's own.
        const gl::Texture* any = colours.empty() ? depth : colours.front();
        assert(any);
        drawSeen(view, scene, any->size().x / view.canvas.size.x, framebuffer, linked, depth);
    }
    for (const auto& part : pass.rasterViews) {
        gl::setViewport({part.viewport.x, part.viewport.y}, {part.viewport.z, part.viewport.w});
        linked.setInt("rasterView", part.number);
        scene.draw();
    }
    gl::barrier();
}

}  // namespace limn
