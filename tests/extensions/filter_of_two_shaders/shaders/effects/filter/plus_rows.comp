// The mean of the two neighbours in a pixel's row.
#include "lib/space.glsl"

float at(ivec2 pixel) { return load(source, clamp(pixel, ivec2(0), view.size - 1)).r; }

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    write_result(vec4(0.5 * (at(pixel - ivec2(1, 0)) + at(pixel + ivec2(1, 0)))));
}
