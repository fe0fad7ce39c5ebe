// Lines over shaded objects over the background, all premultiplied.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(shade, pixel);
#ifdef WITH_EDGES
    vec4 line = load(edges, pixel);
    color = line + color * (1.0 - line.a);
#endif
    color += params.background * (1.0 - color.a);
#ifdef WITH_FACTOR
    // Darkening of the background stays even where the background is left out.
    float factor_ = load(factor, pixel).r;
    color = vec4(color.rgb * factor_, mix(1.0, color.a, factor_));
#endif
    write_result(color);
}
