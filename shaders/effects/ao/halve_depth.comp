// Every second depth each way. It takes pixels, not means of pixels, so that each depth is that of a real surface.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    write_result(load(depth, pixel * COARSENESS));
}
