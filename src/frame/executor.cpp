#include "frame/executor.h"

#include "base/error.h"

#include <fmt/format.h>

#include <optional>

namespace limn {
namespace {

constexpr glm::ivec2 kGroup(8, 8);

const Resource& resourceOf(const Graph& graph, ResourceId id) { return graph.resources[static_cast<std::size_t>(id.index)]; }

/// Declarations that every shader of the pass starts with, generated from what the pass declared: a shader can touch nothing else.
std::string prelude(const Graph& graph, const PlannedPass& planned, const UniformBlock& view) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    std::string text = "#version 450 core\n";
    for (const auto& [name, value] : pass.defines) text += fmt::format("#define {} {}\n", name, value);
    text += view.glsl + pass.params.glsl;
    return text;
}

std::string samplers(const Graph& graph, const Pass& pass) {
    std::string text;
    int unit = 0;
    for (const auto& read : pass.reads)
        text += fmt::format("layout(binding = {}) uniform {}sampler2D {};\n", unit++, info(resourceOf(graph, read.resource).format).glslPrefix, read.name);
    return text;
}

}  // namespace

const gl::Program& Executor::program(const Graph& graph, const PlannedPass& planned, const UniformBlock& view) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    std::vector<gl::ShaderStage> stages;
    std::string head = prelude(graph, planned, view), outputs;
    int slot = 0;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        if (!planned.writes[w]) continue;
        const Write& write = pass.writes[w];
        const FormatInfo format = info(resourceOf(graph, write.resource).format);
        if (pass.kind == Pass::Kind::compute) {
            outputs += fmt::format("layout(binding = {}, {}) uniform {} {}image2D {};\n#define WRITES_{}\n", slot++, format.glslImage, write.update ? "" : "writeonly", format.glslPrefix, write.name, write.name);
        } else if (!format.glslImage.empty()) {
            constexpr std::string_view floats[] = {"", "float", "vec2", "vec3", "vec4"}, integers[] = {"", "uint", "uvec2", "uvec3", "uvec4"};
            const auto channels = static_cast<std::size_t>(format.channels);
            outputs += fmt::format("layout(location = {}) out {} {};\n#define WRITES_{}\n", slot++, format.glslPrefix == "u" ? integers[channels] : floats[channels], write.name, write.name);
        }
    }
    if (pass.kind == Pass::Kind::compute) {
        head += fmt::format("layout(local_size_x = {}, local_size_y = {}) in;\n", kGroup.x, kGroup.y);
        stages.push_back({gl::ShaderStage::Kind::compute, head + samplers(graph, pass) + outputs + shaders_.load(pass.shader + ".comp")});
    } else {
        // The vertex stage needs to know what is written, so that it hands on nothing else.
        std::string names;
        for (std::size_t w = 0; w < pass.writes.size(); ++w)
            if (planned.writes[w]) names += fmt::format("#define WRITES_{}\n", pass.writes[w].name);
        stages.push_back({gl::ShaderStage::Kind::vertex, head + names + shaders_.load(pass.shader + ".vert")});
        stages.push_back({gl::ShaderStage::Kind::fragment, head + samplers(graph, pass) + outputs + shaders_.load(pass.shader + ".frag")});
    }
    std::string key;
    for (const auto& stage : stages) key += stage.source;
    auto it = programs_.find(key);
    if (it == programs_.end()) it = programs_.emplace(key, gl::Program(stages, pass.name)).first;
    return it->second;
}

void Executor::prepare(const Graph& graph, const Plan& plan, const View& view) {
    const UniformBlock block = viewBlock(view);
    for (const auto& planned : plan.passes) program(graph, planned, block);
}

void Executor::allocate(const Plan& plan) {
    for (std::size_t i = 0; i < plan.textures.size(); ++i) {
        const auto& wanted = plan.textures[i];
        auto& texture = textures_[i];
        if (!texture || texture.format() != wanted.format || texture.size() != wanted.size) {
            texture = {};  // gives the old one back first
            texture = gl::Texture(wanted.format, wanted.size, fmt::format("texture {}", i));
        }
    }
    textures_.erase(textures_.lower_bound(plan.textures.size()), textures_.end());
}

const gl::Texture& Executor::texture(const Plan& plan, ResourceId resource) const {
    return textures_.at(static_cast<std::size_t>(plan.textureOf[static_cast<std::size_t>(resource.index)]));
}

void Executor::run(const Graph& graph, const Plan& plan, const View& view, const GpuScene& scene, bool measure) {
    allocate(plan);
    const UniformBlock block = viewBlock(view);
    const gl::Buffer viewBuffer(block.bytes, "view");
    std::vector<gl::TimerQuery> queries;
    if (measure && !timerIsWarm_) {
        // The first timer query of a process gives garbage on llvmpipe: let it measure nothing.
        const gl::TimerQuery discarded;
        discarded.begin();
        discarded.end();
        static_cast<void>(discarded.milliseconds());
        timerIsWarm_ = true;
    }
    for (const auto& planned : plan.passes) {
        const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
        const gl::DebugGroup group(pass.name);
        if (measure) queries.emplace_back().begin();
        const gl::Program& linked = program(graph, planned, block);
        linked.use();
        viewBuffer.bindUniform(0);
        std::optional<gl::Buffer> params;
        if (!pass.params.bytes.empty()) params.emplace(pass.params.bytes, pass.name + " params").bindUniform(1);
        scene.bind();
        int unit = 0;
        for (const auto& read : pass.reads) texture(plan, read.resource).bindSampler(unit++);
        if (pass.kind == Pass::Kind::compute) runCompute(graph, plan, planned);
        else runRaster(graph, plan, planned, view, scene, linked);
        if (measure) {
            gl::finish();
            queries.back().end();
        }
    }
    if (measure) {
        milliseconds_.resize(plan.passes.size());
        for (std::size_t i = 0; i < queries.size(); ++i) milliseconds_[i] += queries[i].milliseconds();
    }
    device_.check("drawing");
}

void Executor::runCompute(const Graph& graph, const Plan& plan, const PlannedPass& planned) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    glm::ivec2 size(0);
    int slot = 0;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        if (!planned.writes[w]) continue;
        const auto& image = texture(plan, pass.writes[w].resource);
        image.bindImage(slot++, pass.writes[w].update);
        size = glm::max(size, image.size());
    }
    gl::dispatch(size, kGroup);
}

void Executor::runRaster(const Graph& graph, const Plan& plan, const PlannedPass& planned, const View& view, const GpuScene& scene, const gl::Program& linked) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    std::vector<const gl::Texture*> colours;
    std::vector<glm::vec4> clears;
    const gl::Texture* depth = nullptr;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        if (!planned.writes[w]) continue;
        const auto& image = texture(plan, pass.writes[w].resource);
        if (image.format() == Format::depth32f) depth = &image;
        else colours.push_back(&image), clears.push_back(pass.writes[w].clear);
    }
    const gl::Framebuffer framebuffer(colours, depth, pass.name);
    framebuffer.bind();
    for (std::size_t i = 0; i < colours.size(); ++i) {
        if (info(colours[i]->format()).glslPrefix == "u") framebuffer.clearInteger(static_cast<int>(i), glm::uvec4(clears[i]));
        else framebuffer.clearFloat(static_cast<int>(i), clears[i]);
    }
    if (depth) framebuffer.clearDepth(0);
    gl::setDepthTest(depth ? gl::DepthTest::greater : gl::DepthTest::none);
    if (pass.drawings.empty()) {
        // One virtual viewport for the whole picture, shifted by whole pixels: a part of a picture is that part of the whole.
        gl::setViewport(-view.regionOrigin(), view.fineSize());
        scene.draw();
    }
    for (const auto& drawing : pass.drawings) {
        gl::setViewport({drawing.viewport.x, drawing.viewport.y}, {drawing.viewport.z, drawing.viewport.w});
        linked.setInt("drawing", drawing.number);
        scene.draw();
    }
    gl::barrier();
}

}  // namespace limn
