// The intensity that toon shading quantizes: (sum of max(0, N·L)·shadow + ambient)·ao + extra ambient + highlights.
//
// Writes it to the red channel. With coloured lights rgb is the light's colour, scaled to a largest channel of 1, and
// alpha is the intensity.
#include "scene/lighting.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float z = load(depth, pixel).r;
    if (isBackground(z)) {
        write_result(vec4(0));
        return;
    }
    vec3 position = viewPosition(pixel, z);
    vec2 highlights = highlightsOf(pixel);
    vec3 eye = params.trueViewDirection ? towardsEye(position) : vec3(0, 0, 1);
    Lighting lit = lightingAt(pixel, position, decodeNormal(load(normal, pixel).xy), eye, highlights.x, vec2(0));
    vec3 light = (lit.diffuse + params.ambient) * openness(pixel, params.aoStrength) + params.extraAmbient
        + lit.highlight * (highlights.y * params.specular);
#ifdef COLORED_LIGHT
    float intensity = max(light.r, max(light.g, light.b));
    write_result(vec4(intensity > 0.0 ? light / intensity : vec3(1), intensity));
#else
    write_result(vec4(light.r));
#endif
}
