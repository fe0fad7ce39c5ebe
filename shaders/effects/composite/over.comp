// Lines over shaded objects over the background, all premultiplied.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = texelFetch(shade, pixel, 0);
#ifdef WITH_EDGES
    vec4 line = texelFetch(edges, pixel, 0);
    color = line + color * (1.0 - line.a);
#endif
    color += params.background * (1.0 - color.a);
#ifdef WITH_FACTOR
    // Where the background is left out, what darkens it stays.
    float factor_ = texelFetch(factor, pixel, 0).r;
    color = vec4(color.rgb * factor_, mix(1.0, color.a, factor_));
#endif
    write_result(color);
}
