// The mean of a square of pixels.
#include "lib/space.glsl"

float weightOf(int i) {
#ifdef HALF_ENDS
    return i == FIRST || i == LAST ? 0.5 : 1.0;
#else
    return 1.0;
#endif
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float sum = 0.0;
    for (int y = FIRST; y <= LAST; ++y)
        for (int x = FIRST; x <= LAST; ++x)
            sum += weightOf(x) * weightOf(y) * load(source, clamp(pixel + ivec2(x, y), ivec2(0), view.size - 1)).r;
    write_result(vec4(sum / float(SIZE * SIZE)));
}
