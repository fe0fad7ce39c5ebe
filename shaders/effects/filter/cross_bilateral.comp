// One direction of a depth-dependent Gaussian.
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/likeness.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float centre = load(depth, pixel).r, here = load(source, pixel).r;
    if (isBackground(centre)) {
        write_result(vec4(here));
        return;
    }
    float perFootprint = 1.0 / pixelFootprint(centre), sum = here, total = 1.0;
#ifdef BY_PLANE
    vec3 position = viewPosition(pixel, centre), n = decodeNormal(load(normal, pixel).xy);
#endif
    for (int i = -HALF; i <= HALF; ++i) {
        // Beyond the region drawn, taps repeat the border's pixel, which is alike only if it is near.
        ivec2 tap = clamp(pixel + params.axis * i, ivec2(0), view.size - 1);
        if (tap == pixel) continue;
        float there = load(depth, tap).r;
#ifdef BY_PLANE
        float off = offPlane(position, n, perFootprint, tap, there);
#else
        float off = abs(there - centre) * perFootprint;
#endif
        float weight = params.weights[abs(i) / 4][abs(i) & 3] * bell(min(off * params.perStep, 1.0));
        sum += weight * load(source, tap).r, total += weight;
    }
    write_result(vec4(sum / total));
}
