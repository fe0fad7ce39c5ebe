// Lines over shaded objects over the background, all premultiplied.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!insideRegion(pixel)) return;
    vec4 color = texelFetch(shade, pixel, 0);
#ifdef WITH_EDGES
    vec4 line = texelFetch(edges, pixel, 0);
    color = line + color * (1.0 - line.a);
#endif
    imageStore(result, pixel, color + params.background * (1.0 - color.a));
}
