// One application of the 3×3 Gaussian (1 2 1)⊗(1 2 1)/16, whose taps are output pixels apart.
#include "lib/space.glsl"

const float WEIGHTS[3] = float[](0.25, 0.5, 0.25);

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = pixel + ivec2(x, y) * view.raster;
            // Off the picture: the nearest pixel of the same sample.
            ivec2 within = pixel % view.raster;
            tap = clamp(tap, within, view.size - view.raster + within);
            sum += WEIGHTS[x + 1] * WEIGHTS[y + 1] * texelFetch(source, tap, 0).r;
        }
    write_result(vec4(sum));
}
