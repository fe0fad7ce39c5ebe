// Ambient occlusion alone.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float open = isBackground(load(depth, pixel).r) ? 0.0 : 1.0;
    vec3 color = params.color.rgb * open;
#ifdef WITH_AO
    color *= load(ambientOcclusion, pixel).r;
#endif
    write_result(vec4(color, open));
}
