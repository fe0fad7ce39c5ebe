// Paper under a wash of ambient occlusion.
#include "scene/scene.glsl"
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float alpha = isBackground(load(depth, pixel).r) ? 0.0 : 1.0;
    vec3 color = params.color;
    float open = 1.0, tint = params.tint;
#ifdef WITH_AO
    open = mix(1.0, load(ambientOcclusion, pixel).r, params.ao_strength);
#endif
#ifdef WITH_SECTIONS
    if (lineRecordAt(load(lineRecord, pixel).r).isCut) tint = 1.0, open = 1.0;
#endif
#ifdef WITH_ALBEDO
    color = mix(color, load(albedo, pixel).rgb, tint);
#endif
    write_result(vec4(mix(params.wash_color, color, open) * alpha, alpha));
}
