// Lines where depth or normal jump: pass 5 of Lajzer & Nottingham.
//
// Each pixel is compared with its neighbours; a line of the wanted width is drawn along the sides between those that differ. The paper
// compares a pixel with eight others instead, which draws the same line two pixels wide and no other width. Reads depth and normal;
// writes edges: the lines in their colour, premultiplied, over those of the layers before.
//
// Paper mode: |Δdepth| > 0.05·(1 − depth) on the standard post-projection depth, N·N' < 0.95.
// Default mode: distance to the other's tangent plane, the larger of both ways round, in multiples of the pixel's footprint (a plane seen
// at any tilt has no false line), and the angle between the normals.

#include "effects/edges/stroke.h"

#include <cmath>

namespace limn {
enum class DepthTest { plane, projected };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<DepthTest> = {"plane", "projected"};

namespace edges_depth_normal {

struct Params {
    PictureLength width = PictureLength::pixels(2);
    Color color{0.0103f, 0.0103f, 0.0103f};   // #1a1a1a
    float opacity = 1;
    float step = 4;
    float creaseAngle = 40;
    DepthTest depthTest = DepthTest::plane;
    float depthThreshold = 0.05f;
};

constexpr Field kParams[] = {
    field<&Params::width>("width", {.unit = "picture", .min = 0, .max = 1000, .doc = "Width of the lines: pixels, \"0.35mm\" or \"0.2%\" of the image height."}),
    field<&Params::color>("color", {.doc = "Colour of the lines."}),
    field<&Params::opacity>("opacity", {.min = 0, .max = 1, .doc = "How much the lines cover; at 0 they are not even computed."}),
    field<&Params::step>("step", {.unit = "pixel footprints", .min = 0.01, .max = 1e6, .doc = "Smallest step between surfaces that is drawn, in widths of a pixel at that depth (depth_test = \"plane\")."}),
    field<&Params::creaseAngle>("crease_angle", {.unit = "degrees", .min = 0.1, .max = 180, .doc = "Smallest angle between normals that is drawn."}),
    field<&Params::depthTest>("depth_test", {.doc = "Distance to the tangent plane, or difference of projected depths as the paper does."}),
    field<&Params::depthThreshold>("depth_threshold", {.min = 0, .max = 1, .doc = "Factor on (1 - depth) (depth_test = \"projected\")."}),
};

struct Constants {
    float step = 4, cosine = 0.95f, depthThreshold = 0.05f, near = 0.1f, far = 100;
};
constexpr Field kConstants[] = {
    field<&Constants::step>("step", {.unit = "pixel footprints", .doc = "Smallest step that is drawn."}),
    field<&Constants::cosine>("cosine", {.doc = "Normals with a smaller cosine between them make a line."}),
    field<&Constants::depthThreshold>("depthThreshold", {.doc = "Factor on (1 - projected depth)."}),
    field<&Constants::near>("near", {.unit = "normalized units", .doc = "Where the projected depth is 0."}),
    field<&Constants::far>("far", {.unit = "normalized units", .doc = "Where the projected depth is 1."}),
};

Constants derive(const Params& params, const View& view) {
    Constants c;
    c.step = params.step;
    c.cosine = static_cast<float>(std::cos(glm::radians(static_cast<double>(params.creaseAngle))));
    c.depthThreshold = params.depthThreshold;
    c.far = static_cast<float>(view.far);
    // Our own near distance is far too small for a projected depth to mean anything; a 256th of the far distance is what programs of the
    // paper's time used.
    c.near = static_cast<float>(std::max(view.near, view.far / 256));
    return c;
}

void build(EffectBuilder& graph, const Params& params) {
    if (params.opacity <= 0 || params.width.amount <= 0) return;
    const ResourceId sides = graph.image("line_sides" + graph.layerSuffix(), Format::r8);
    Pass pass;
    pass.name = "depth_normal" + graph.layerSuffix();
    pass.reads = {{"depth", graph.read(aov::depth), 1}, {"normal", graph.read(aov::normal), 1}};
    if (params.depthTest == DepthTest::projected) pass.defines.emplace_back("PROJECTED_DEPTH", "");
    else pass.reads.push_back({"normalGeometric", graph.read(aov::normalGeometric), 1});
    pass.writes = {{"result", sides}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    pass.note = "2 neighbours per pixel";
    graph.add(std::move(pass));
    strokeLines(graph, sides, {params.width, params.color, params.opacity});
}

const Technique kDepthNormal{"edges", "depth_normal", "Lines where depth or normal jump (Lajzer & Nottingham).", kParams, build,
                             {{"paper", "As published: projected depth, normals more than 18 degrees apart, black lines two pixels wide.",
                               "width = '2px', color = '#000000', crease_angle = 18.1949, depth_test = 'projected', depth_threshold = 0.05"}}};

}  // namespace edges_depth_normal
}  // namespace limn
