// (1 2 1)/4 applied TAPS_BESIDE times, along rows or along columns: binomial weights.
#include "lib/space.glsl"

float sourceAt(ivec2 pixel) { return load(source, clamp(pixel, ivec2(0), view.size - 1)).r; }

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float weight = params.middle, sum = weight * sourceAt(pixel);
    for (int k = 1; k <= TAPS_BESIDE; ++k) {
        // C(2n, n + k) follows from C(2n, n + k - 1).
        weight *= float(TAPS_BESIDE - k + 1) / float(TAPS_BESIDE + k);
        sum += weight * (sourceAt(pixel + k * params.axis) + sourceAt(pixel - k * params.axis));
    }
    write_result(vec4(sum));
}
