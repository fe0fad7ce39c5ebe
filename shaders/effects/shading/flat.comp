// The objects' own colours, times ambient occlusion.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(albedo, pixel);
#ifdef WITH_AO
    color.rgb *= mix(1.0, load(ambientOcclusion, pixel).r, params.aoStrength);
#endif
    write_result(color);
}
