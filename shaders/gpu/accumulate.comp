// Adds a sample to the sum over a pixel's samples.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (insideRegion(pixel)) write_sum(load(source, pixel));
}
