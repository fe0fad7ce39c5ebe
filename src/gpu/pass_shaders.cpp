#include "gpu/pass_shaders.h"

#include <fmt/format.h>

namespace limn {
namespace {

using Kind = gl::ShaderStage::Kind;

constexpr int kMostInputs = 24;  // vectors of four handed on to a fragment shader; with those of three suns fewer than
                                 // the 32 of Mesa's software renderers

FormatInfo formatOf(const Graph& graph, ResourceId id) {
    return info(graph.resources[static_cast<std::size_t>(id.index)].format);
}

/// The beginning of all stages.
std::string head(const Pass& pass, const View& view) {
    std::string text = "#version 450 core\n";
    for (const auto& [name, value] : pass.defines) text += fmt::format("#define {} {}\n", name, value);
    text += fmt::format("const int MASK_TILE = {};\n", kMaskTile);
    // A constant, since software renderers would compute both kinds of everything.
    return text + fmt::format("const bool ORTHOGRAPHIC = {};   // parallel rays\n", view.orthographic);
}

/// The images that a pass reads, each by load(name, pixel). Software renderers load from images a quarter faster than
/// from textures, whose levels they look up for every pixel. Depth cannot be an image, and is a texture everywhere.
std::string inputs(const Graph& graph, const Pass& pass, bool asImages) {
    std::string text = asImages ? "#define load(image, pixel) imageLoad(image, pixel)\n"
                                : "#define load(image, pixel) texelFetch(image, pixel, 0)\n";
    int unit = 0;
    for (const auto& read : pass.reads) {
        const FormatInfo format = formatOf(graph, read.resource);
        if (asImages && !format.glslImage.empty())
            text += fmt::format("layout(binding = {}, {}) uniform readonly {}image2D {};\n", unit++, format.glslImage,
                format.glslPrefix, read.name);
        else
            text += fmt::format("layout(binding = {}) uniform {}sampler2D {};\n", unit++, format.glslPrefix, read.name);
    }
    return text;
}

/// WRITES_name for each image that a pass makes.
std::string namesOfOutputs(const PlannedPass& planned, const Pass& pass) {
    std::string text;
    for (std::size_t w = 0; w < pass.writes.size(); ++w)
        if (planned.writes[w]) text += fmt::format("#define WRITES_{}\n", pass.writes[w].name);
    return text;
}

/// The images that a pass makes, except depth: an output of a raster pass, else a function write_name().
std::string outputs(const Graph& graph, const PlannedPass& planned, const Pass& pass, ComputeAs computeAs) {
    constexpr std::string_view floats[] = {"", "float", "vec2", "vec3", "vec4"},
                               integers[] = {"", "uint", "uvec2", "uvec3", "uvec4"};
    constexpr std::string_view swizzles[] = {"", "x", "xy", "xyz", "xyzw"};
    std::string text;
    int number = 0;
    for (std::size_t w = 0; w < pass.writes.size(); ++w) {
        const Write& write = pass.writes[w];
        const FormatInfo format = formatOf(graph, write.resource);
        if (!planned.writes[w] || format.glslImage.empty()) continue;
        const auto channels = static_cast<std::size_t>(format.channels);
        const auto& types = format.glslPrefix == "u" ? integers : floats;
        if (pass.kind == Pass::Kind::raster) {
            text += fmt::format("layout(location = {}) out {} {};\n", number++, types[channels], write.name);
        } else if (computeAs == ComputeAs::fragments) {  // sums are made by blending
            text +=
                fmt::format("layout(location = {0}) out {1} out_{2};\nvoid write_{2}({3} v) {{ out_{2} = v.{4}; }}\n",
                    number++, types[channels], write.name, types[4], swizzles[channels]);
        } else {
            const std::string place = "ivec2(gl_GlobalInvocationID.xy)";
            const std::string value = write.sums
                ? fmt::format("v + (view.sampleNumber > 0 ? imageLoad({}, {}) : vec4(0))", write.name, place)
                : "v";
            text += fmt::format("layout(binding = {}, {}) uniform {} {}image2D {};\n", number++, format.glslImage,
                write.sums ? "" : "writeonly", format.glslPrefix, write.name);
            text += fmt::format(
                "void write_{0}({1} v) {{ imageStore({0}, {2}, {3}); }}\n", write.name, types[4], place, value);
        }
    }
    return text;
}

/// The number of lights that a pass reads, if all are suns without shadows, and few; else 0.
int plainSuns(const Pass& pass) {
    int count = 0;
    for (const auto& [name, value] : pass.defines) {
        if (name == "LIGHT_COUNT") count = std::stoi(value);
        if (name == "PLACED_LIGHTS" || name == "WITH_SHADOWS") return 0;
    }
    return count <= 3 ? count : 0;
}

/// Hands a fragment shader the view, parameters and lights that it uses. Gives the vertex shader's part, with a
/// function handOn(), and the fragment shader's declarations.
HandedOn handAllOn(const Pass& pass, const UniformBlock& view, std::string_view source, const ShaderLibrary& library) {
    HandedOn all = handOn(view, source);
    const HandedOn params = handOn(pass.params, source);
    std::string calls = "handOn_view();";
    if (all.vectors + params.vectors <= kMostInputs) {
        all.vertex += params.vertex;
        all.fragment += params.fragment;
        calls += fmt::format(" handOn_{}();", pass.params.name);
    } else
        all.fragment += pass.params.glsl();
    if (const int suns = plainSuns(pass); suns > 0) {
        all.vertex += fmt::format("#define LIGHT_COUNT {}\n", suns) + library.load("gpu/hand_on_suns.glsl");
        all.fragment += "#define SUNS_HANDED_ON\n";
        calls += " handOnSuns();";
    }
    all.vertex += fmt::format("void handOn() {{ {} }}\n", calls);
    return all;
}

}  // namespace

std::vector<gl::ShaderStage> shadersOf(const Graph& graph, const PlannedPass& planned, const View& view,
    const UniformBlock& viewConstants, ComputeAs computeAs, const ShaderLibrary& library) {
    const Pass& pass = graph.passes[static_cast<std::size_t>(planned.pass)];
    const bool isRaster = pass.kind == Pass::Kind::raster, isDrawn = !isRaster && computeAs == ComputeAs::fragments,
               hasMask = pass.mask >= 0;
    const std::string begin = head(pass, view), blocks = viewConstants.glsl() + pass.params.glsl(),
                      names = namesOfOutputs(planned, pass);
    const std::string images = inputs(graph, pass, isDrawn) + outputs(graph, planned, pass, computeAs);
    if (isRaster)  // the vertex stage hands on only what the written images need
        return {{Kind::vertex, begin + blocks + names + library.load(pass.shader + ".vert")},
            {Kind::fragment, begin + blocks + names + images + library.load(pass.shader + ".frag")}};

    const std::string source = library.load(pass.shader + ".comp");
    if (!isDrawn) {
        const std::string place = fmt::format(
            "layout(local_size_x = {}, local_size_y = {}) in;\nivec2 thisPixel() {{ return "
            "ivec2(gl_GlobalInvocationID.xy); }}\n",
            kWorkGroup.x, kWorkGroup.y);
        const std::string mask = hasMask ? fmt::format("(load({}, (pixel) / MASK_TILE).r == 0.0)",
                                     pass.reads[static_cast<std::size_t>(pass.mask)].name)
                                         : "false";
        return {{Kind::compute,
            begin + blocks + place + names + fmt::format("#define IS_MASKED(pixel) {}\n", mask) + images + source}};
    }
    // Only tiles of the mask are drawn: the shader need not test it.
    const std::string place = "ivec2 thisPixel() { return ivec2(gl_FragCoord.xy); }\n#define IS_MASKED(pixel) false\n";
    if (hasMask)  // handing constants on for each tile costs more than it saves
        return {{Kind::vertex, "#version 450 core\n" + library.load("gpu/tiles.vert")},
            {Kind::fragment, begin + blocks + place + names + images + source}};
    const HandedOn constants =
        handAllOn(pass, viewConstants, begin + source, library);  // defines may name constants too
    return {{Kind::vertex, "#version 450 core\n" + constants.vertex + library.load("gpu/screen.vert")},
        {Kind::fragment, begin + constants.fragment + place + names + images + source}};
}

}  // namespace limn
