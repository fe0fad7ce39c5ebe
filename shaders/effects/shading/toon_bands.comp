// Quantizes the intensity into bands and colours the object by them.
#include "lib/space.glsl"
#include "lib/color.glsl"

// An intensity this far below a threshold already reaches it: a face lit exactly at a threshold then lies safely inside
// its band, whatever the last bits of its normal.
const float BAND_BIAS = 1e-4;

#ifdef COLORED_LIGHT
float intensityAt(ivec2 pixel) { return load(light, pixel).a; }
#else
float intensityAt(ivec2 pixel) { return load(light, pixel).r; }
#endif

// The smaller of the differences to both sides: at an object's edge only one of them is meaningful.
float slope(ivec2 pixel, ivec2 axis, float here) {
    ivec2 lower = max(pixel - axis, ivec2(0)), upper = min(pixel + axis, view.size - 1);
    float back = lower == pixel ? 1e30 : abs(here - intensityAt(lower));
    float forth = upper == pixel ? 1e30 : abs(intensityAt(upper) - here);
    float least = min(back, forth);
    return least < 1e30 ? least : 0.0;
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(albedo, pixel);
    float intensity = intensityAt(pixel);
    // Intensity changes this much over the wanted width of a band's edge.
    float width = params.edgeSoftness <= 0.0 ? 0.0
                                             : params.edgeSoftness
            * length(vec2(slope(pixel, ivec2(1, 0), intensity), slope(pixel, ivec2(0, 1), intensity)));

    float steepness = 1.0 / max(width, 1e-6);
    vec3 level = params.bands[0].rgb;
    for (int i = 1; i < BAND_COUNT; ++i) {
        float beyond = intensity + BAND_BIAS - params.bands[i].a;
        float reached = width > 1e-6 ? clamp(beyond * steepness + 0.5, 0.0, 1.0) : (beyond >= 0.0 ? 1.0 : 0.0);
        level += (params.bands[i].rgb - params.bands[i - 1].rgb) * reached;
    }
#ifdef COLORED_LIGHT
    level *= load(light, pixel).rgb;
#endif
#ifdef DISPLAY_ENCODED
    color.rgb = srgbToLinear(clamp(linearToSrgb(color.rgb) * level, 0.0, 1.0)) * color.a;
#else
    color.rgb *= level;
#endif
    write_result(color);
}
