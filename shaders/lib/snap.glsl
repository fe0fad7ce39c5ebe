// Vertices on a grid of 1/256 fine pixel, counted over the picture and its guard band.
//
// Every part of a picture then has the same triangles to the bit. The grid is the rasterizer's own, so nothing is lost.

vec4 snapToGrid(vec4 clip) {
    if (clip.w <= 0.0) return clip;  // behind the eye: the clipper will replace it
    vec2 size = vec2(view.canvasSize * view.raster);
    precise vec2 pixel = (clip.xy / clip.w * 0.5 + 0.5) * size;
    // Far outside, a float no longer resolves 1/256.
    if (any(greaterThan(abs(pixel), vec2(32768.0)))) return clip;
    pixel = round(pixel * 256.0) / 256.0;
    precise vec2 ndc = pixel / size * 2.0 - 1.0;
    return vec4(ndc * clip.w, clip.zw);
}
