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
    write_result(color + params.background * (1.0 - color.a));
}
