// The objects' own colours, times ambient occlusion.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = texelFetch(albedo, pixel, 0);
#ifdef WITH_AO
    color.rgb *= mix(1.0, texelFetch(ambientOcclusion, pixel, 0).r, params.aoStrength);
#endif
    write_result(color);
}
