// Ambient occlusion, depth and normal of each pixel in one image, for filters that fetch all three of every tap.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    write_result(vec4(load(source, pixel).r, load(depth, pixel).r, load(normal, pixel).xy));
}
