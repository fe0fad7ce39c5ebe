// 3×3 taps over the pixel's own plane, `spacing` pixels apart. A surface is ambient occlusion, depth, and the normal's
// two coordinates.
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/likeness.glsl"

// A tent's taps, over the middle one.
const float WEIGHTS[2] = float[](1.0, 0.5);

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 here = load(surfaces, pixel);
    if (isBackground(here.y)) {
        write_result(here);
        return;
    }
    vec3 position = viewPosition(pixel, here.y), n = decodeNormal(here.zw);
    float perFootprint = params.perStep / pixelFootprint(here.y), sum = here.x, total = 1.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) continue;
            ivec2 tap = clamp(pixel + ivec2(x, y) * params.spacing, ivec2(0), view.size - 1);
            vec4 there = load(surfaces, tap);
            vec3 turned = decodeNormal(there.zw) - n;
            float off = offPlane(position, n, perFootprint, tap, there.y);
            // Squared inside: bell() of all distances at once.
            float apart = (there.x - here.x) * params.perDifference;
            float unlike = min(off * off, 4.0) + dot(turned, turned) * params.perTurn + apart * apart,
                  rest = max(1.0 - unlike, 0.0);
            float weight = WEIGHTS[abs(x)] * WEIGHTS[abs(y)] * rest * rest;
            sum += weight * there.x, total += weight;
        }
    write_result(vec4(sum / total, here.yzw));
}
