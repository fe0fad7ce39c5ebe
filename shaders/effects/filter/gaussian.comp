// One application of the 3×3 Gaussian (1 2 1)⊗(1 2 1)/16.
#include "lib/space.glsl"

const float WEIGHTS[3] = float[](0.25, 0.5, 0.25);

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = clamp(pixel + ivec2(x, y), ivec2(0), view.size - 1);
            sum += WEIGHTS[x + 1] * WEIGHTS[y + 1] * texelFetch(source, tap, 0).r;
        }
    write_result(vec4(sum));
}
