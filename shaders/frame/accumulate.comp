// A sample's part of the mean over a pixel's samples.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (insideRegion(pixel)) write_mean(load(source, pixel));
}
