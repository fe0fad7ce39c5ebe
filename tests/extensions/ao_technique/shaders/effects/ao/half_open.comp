// Every surface is as open as it is told to be.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    write_result(vec4(isBackground(load(depth, pixel).r) ? 1.0 : params.open));
}
