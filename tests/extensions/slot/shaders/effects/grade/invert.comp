// The negative of premultiplied colours.
#include "lib/space.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(source, pixel);
    write_result(vec4(color.a - color.rgb, color.a));
}
