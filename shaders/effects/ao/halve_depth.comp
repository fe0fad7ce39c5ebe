// Every second depth each way: of pixels, not of means of pixels, so that each is the depth of a real surface.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    write_result(load(depth, pixel * COARSENESS));
}
