// Toon shading: pass 4 of Lajzer & Nottingham, with lights, shadows and evenly spaced bands.
//
// Two passes: toon_light computes the intensity I = (sum of max(0, N·L)·shadow + ambient)·ao + extra_ambient +
// highlights, toon_bands quantizes it. Reads depth, normal, albedo, material_id and, where there is any,
// ambient_occlusion; writes shade.
//
// Paper mode: floor(4·I)/4 of display-encoded colour. Levels above 1 appear and clip. The half vector uses a constant
// view direction.
// Default mode: exactly n bands, evenly spaced to the eye, with the true view direction and band edges one pixel soft.
// A band begins at its threshold less 1e-4, so that a face lit exactly at a threshold does not flicker with the last
// bit of its normal.

#include "effects/shading/lighting.h"

#include "settings/color.h"

namespace limn {
enum class ToonSpace { perceptual, display };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<ToonSpace> = {"perceptual", "display"};

namespace shading_toon {

constexpr int kMaxBands = 16;

struct Params {
    int bands = 4;
    float ambient = 0.1f;
    float extraAmbient = 0.2f;
    float specular = 1;
    float edgeSoftness = 1;
    float aoStrength = 1;
    float floorLevel = 0;
    bool trueViewDirection = true;
    ToonSpace space = ToonSpace::perceptual;
    std::vector<Color> ramp;
};

constexpr Field kParams[] = {
    field<&Params::bands>("bands", {.min = 2, .max = kMaxBands, .keyable = false}, "Number of brightness steps."),
    field<&Params::ambient>(
        "ambient", {.min = 0, .max = 10}, "Light that comes from everywhere and that ambient occlusion dims."),
    field<&Params::extraAmbient>(
        "extra_ambient", {.min = 0, .max = 10}, "Light that nothing dims: keeps shadows from going black."),
    field<&Params::specular>("specular", {.min = 0, .max = 10}, "Strength of all highlights."),
    field<&Params::edgeSoftness>("edge_softness", {.unit = "pixels", .min = 0, .max = 64},
        "Width over which a band turns into the next; 0 = hard."),
    field<&Params::aoStrength>("ao_strength", {.min = 0, .max = 1},
        "How much of the ambient occlusion is applied; at 0 it is not even computed."),
    field<&Params::floorLevel>(
        "floor", {.min = 0, .max = 1}, "Brightness of the darkest band, to the eye (0 black, 1 the full colour)."),
    field<&Params::trueViewDirection>(
        "true_view_direction", "Highlights follow the eye; false: as if seen from far away, as the paper does."),
    field<&Params::space>(
        "space", "Quantize what the eye sees of linear light, or display-encoded numbers as the paper does."),
    field<&Params::ramp>(
        "ramp", "A colour for each band, darkest first, instead of even greys; sets the number of bands."),
};

struct LightConstants {
    float ambient = 0, extraAmbient = 0, specular = 0, aoStrength = 1;
    bool trueViewDirection = true;
};
constexpr Field kLightConstants[] = {
    field<&LightConstants::ambient>("ambient", "Light from everywhere, dimmed by ambient occlusion."),
    field<&LightConstants::extraAmbient>("extraAmbient", "Light that nothing dims."),
    field<&LightConstants::specular>("specular", "Strength of all highlights."),
    field<&LightConstants::aoStrength>("aoStrength", "0 none, 1 all of the ambient occlusion."),
    field<&LightConstants::trueViewDirection>("trueViewDirection", "Highlights from the true direction to the eye."),
};

struct BandConstants {
    float edgeSoftness = 0;
};
constexpr Field kBandConstants[] = {
    field<&BandConstants::edgeSoftness>("edgeSoftness", {.unit = "pixels"}, "Width of the transition between bands."),
};

/// rgb: factor on the object's colour; a: intensity at which the band begins.
std::vector<glm::vec4> deriveBands(const Params& params) {
    std::vector<glm::vec4> bands;
    if (params.space == ToonSpace::display) {
        // floor(n·I)/n without an upper end: the levels above 1 clip when the colour is encoded.
        for (int i = 0; i < 4 * params.bands; ++i) {  // up to four times the full colour
            const float level = static_cast<float>(i) / static_cast<float>(params.bands);
            bands.emplace_back(glm::vec3(level), level);
        }
        return bands;
    }
    const int count = params.ramp.empty() ? params.bands : static_cast<int>(params.ramp.size());
    for (int i = 0; i < count; ++i) {
        const float n = static_cast<float>(count), step = static_cast<float>(i);
        const float level = srgbToLinear(params.floorLevel + (1 - params.floorLevel) * (n > 1 ? step / (n - 1) : 1));
        const Color color = params.ramp.empty() ? Color{level, level, level} : params.ramp[static_cast<std::size_t>(i)];
        bands.emplace_back(color.r, color.g, color.b, srgbToLinear(step / n));
    }
    return bands;
}

void build(EffectBuilder& graph, const Params& params) {
    if (params.ramp.size() > kMaxBands)
        throw Error(ExitCode::usage, {}, "the 'ramp' of [shading] has more than 16 colours", "leave some out");
    const bool colored = graph.scene().coloredLight;
    const ResourceId light = graph.image("toon_light", colored ? Format::rgba32f : Format::r32f);
    Pass pass;
    pass.name = "toon_light";
    pass.shader = "effects/shading/toon_light";
    readLighting(graph, pass, params.aoStrength, params.specular > 0 ? Highlights::ofMaterials : Highlights::none);
    if (colored) pass.defines.emplace_back("COLORED_LIGHT", "");
    pass.writes = {{"result", light}};
    pass.params = paramsBlock(kLightConstants,
        LightConstants{
            params.ambient, params.extraAmbient, params.specular, params.aoStrength, params.trueViewDirection});
    graph.add(std::move(pass));

    const ResourceId result = graph.image(aov::shade);
    Pass bands;
    bands.name = "toon_bands";
    bands.shader = "effects/shading/toon_bands";
    bands.reads = {{"light", light, params.edgeSoftness > 0 ? 1 : 0}, {"albedo", graph.read(aov::albedo)}};
    if (params.space == ToonSpace::display) bands.defines.emplace_back("DISPLAY_ENCODED", "");
    if (colored) bands.defines.emplace_back("COLORED_LIGHT", "");
    bands.writes = {{"result", result}};
    const auto levels = deriveBands(params);
    bands.params = paramsBlock(kBandConstants, BandConstants{params.edgeSoftness});
    appendVectors(bands.params, "bands", levels);
    bands.defines.emplace_back("BAND_COUNT", std::to_string(levels.size()));
    bands.note = std::to_string(params.ramp.empty() ? params.bands : static_cast<int>(levels.size())) + " bands";
    graph.add(std::move(bands));
    graph.publish(aov::shade, result);
}

const Technique kToon{"shading", "toon",
    "Light in a few flat steps, with highlights and shadows (Lajzer & Nottingham).", kParams, build,
    {{"paper", "As published: floor(4·I)/4 of display-encoded colour, hard steps, highlights as if seen from far away.",
        "bands = 4, ambient = 0.1, extra_ambient = 0.2, edge_softness = 0, true_view_direction = false, space = "
        "'display'"}}};

}  // namespace shading_toon
}  // namespace limn
