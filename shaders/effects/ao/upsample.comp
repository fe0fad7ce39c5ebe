// Upsamples an image of every second pixel to full resolution: each pixel from the four texels around it, weighted by
// their nearness and by their distance from the pixel's plane.
#include "lib/space.glsl"
#include "lib/normals.glsl"

const int COARSE = 2;

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float z = load(depth, pixel).r;
    if (isBackground(z)) {
        write_result(vec4(1));
        return;
    }
    vec3 position = viewPosition(pixel, z);
    vec3 n = decodeNormal(load(normal, pixel).xy);
    float perFootprint = 1.0 / pixelFootprint(z);
    ivec2 base = pixel / COARSE, odd = pixel - base * COARSE, last = (view.size - 1) / COARSE;
    float sum = 0.0, total = 0.0, nearest = 3.4e38, ofNearest = 1.0;
    for (int i = 0; i < 4; ++i) {
        // Without branches: a pixel in line with the texels takes the same texel twice or four times.
        ivec2 texel = min(base + ivec2(i & 1, i >> 1) * odd, last);
        float there = load(coarseDepth, texel).r, value = load(source, texel).r;
        // The background is farther than any distance.
        float distance =
            isBackground(there) ? 1e9 : abs(dot(viewPosition(texel * COARSE, there) - position, n)) * perFootprint;
        // The weight halves at one footprint off the plane. That separates a corner's two sides, but not a curved
        // surface.
        float weight = 1.0 / (1.0 + distance * distance);
        sum += weight * value, total += weight;
        ofNearest = distance < nearest ? value : ofNearest;
        nearest = min(nearest, distance);
    }
    // If no texel lies near the plane, take the nearest one.
    write_result(vec4(nearest < 4.0 ? sum / total : ofNearest));
}
