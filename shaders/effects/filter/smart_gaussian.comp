// A Gaussian over the pixels that lie on this pixel's surface.
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
    vec3 position = viewPosition(pixel, centre), n = decodeNormal(load(normal, pixel).xy);
    float perFootprint = 1.0 / pixelFootprint(centre), sum = here, total = 1.0;
    for (int y = -HALF; y <= HALF; ++y)
        for (int x = -HALF; x <= HALF; ++x) {
            ivec2 tap = pixel + ivec2(x, y);
            if (tap == pixel || !insideRegion(tap)) continue;
            float there = load(depth, tap).r;
            if (offPlane(position, n, perFootprint, tap, there) > params.step) continue;  // the background too
            if (dot(decodeNormal(load(normal, tap).xy), n) < params.cosine) continue;
            float weight = exp(-float(x * x + y * y) * params.falloff);
            sum += weight * load(source, tap).r, total += weight;
        }
    write_result(vec4(sum / total));
}
