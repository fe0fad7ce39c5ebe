// First half of the distance to the nearest line: along the pixel's own row. The second half, stroke.comp, adds the rows together: a
// Euclidean distance is separable.
#include "lib/space.glsl"
#include "lib/stroke.glsl"

// x: distance to the nearest line along a right side of the row; y: how far to the side lies the nearest line along an upper side of it.
void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec2 nearest = vec2(NO_LINE);
    for (int x = -params.window; x <= params.window; ++x) {
        ivec2 tap = pixel + ivec2(x, 0);
        if (!insideRegion(tap)) continue;
        vec2 distance = vec2(abs(float(x) + 0.5), max(abs(float(x)) - 0.5, 0.0));
        nearest = min(nearest, mix(vec2(NO_LINE), distance, decodeSides(texelFetch(sides, tap, 0).r)));
    }
    write_result(vec4(nearest, 0, 0));
}
