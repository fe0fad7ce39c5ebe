// Draws lines of a width around where they run, from what stroke_rows.comp found in each row.
#include "lib/space.glsl"
#include "lib/stroke.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float nearest = NO_LINE;   // squared
    for (int y = -params.window; y <= params.window; ++y) {
        ivec2 tap = pixel + ivec2(0, y);
        if (!insideRegion(tap)) continue;
        vec2 row = texelFetch(rows, tap, 0).xy;
        float toRight = max(abs(float(y)) - 0.5, 0.0), toUpper = float(y) + 0.5;
        nearest = min(nearest, min(row.x * row.x + toRight * toRight, row.y * row.y + toUpper * toUpper));
    }
    // Whole where the pixel lies in the line by half a pixel, gone where it lies out by as much: the width is right on average, however
    // little of a pixel it is.
    vec4 color = params.color * clamp(params.reach - sqrt(nearest) + 0.5, 0.0, 1.0);
#ifdef LAYERS_BELOW
    color += texelFetch(layersBelow, pixel, 0) * (1.0 - color.a);
#endif
    write_result(color);
}
