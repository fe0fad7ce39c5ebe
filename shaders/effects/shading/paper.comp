// Paper under a wash of ambient occlusion.
#include "frame/scene.glsl"
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float alpha = isBackground(texelFetch(depth, pixel, 0).r) ? 0.0 : 1.0;
    vec3 color = params.color;
    float open = 1.0, tint = params.tint;
#ifdef WITH_AO
    open = mix(1.0, texelFetch(ambientOcclusion, pixel, 0).r, params.ao_strength);
#endif
#ifdef WITH_SECTIONS
    if (lineRecordAt(texelFetch(lineRecord, pixel, 0).r).isCut) tint = 1.0, open = 1.0;
#endif
#ifdef WITH_ALBEDO
    color = mix(color, texelFetch(albedo, pixel, 0).rgb, tint);
#endif
    write_result(vec4(mix(params.wash_color, color, open) * alpha, alpha));
}
