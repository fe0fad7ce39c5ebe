// Finds where depth or normal jump between a pixel and its neighbours to the right and above; lib/stroke.glsl says how that is written.
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/stroke.glsl"

#ifdef PROJECTED_DEPTH
// Standard depth: 0 at near, 1 at far.
float projected(float z) {
    if (isBackground(z)) return 1.0;
    return view.orthographic ? (z - params.near) / (params.far - params.near) : params.far / (params.far - params.near) * (1.0 - params.near / z);
}
#endif

// What is compared of a pixel.
struct Surface {
    float depth;
    vec3 normal;
#ifndef PROJECTED_DEPTH
    vec3 position, face;    // face: normal of the triangle
#endif
};

Surface surfaceAt(ivec2 pixel) {
    Surface s;
    s.depth = texelFetch(depth, pixel, 0).r;
    s.normal = decodeNormal(texelFetch(normal, pixel, 0).xy);
#ifndef PROJECTED_DEPTH
    s.position = viewPosition(pixel, isBackground(s.depth) ? 0.0 : s.depth);
    s.face = decodeNormal(texelFetch(normalGeometric, pixel, 0).xy);
#endif
    return s;
}

bool isLine(Surface a, Surface b) {
    bool outline = isBackground(a.depth) != isBackground(b.depth), empty = isBackground(a.depth) && isBackground(b.depth);
    bool crease = dot(a.normal, b.normal) < params.cosine;
#ifdef PROJECTED_DEPTH
    bool jump = abs(projected(b.depth) - projected(a.depth)) > params.depthThreshold * (1.0 - projected(a.depth));
#else
    vec3 between = b.position - a.position;
    float distance = max(abs(dot(between, a.face)), abs(dot(between, b.face)));
    bool jump = distance > params.step * pixelFootprint(min(a.depth, b.depth));
#endif
    return outline || (!empty && (crease || jump));
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    Surface here = surfaceAt(pixel);
    bool right = isLine(here, surfaceAt(min(pixel + ivec2(1, 0), view.size - 1)));
    bool above = isLine(here, surfaceAt(min(pixel + ivec2(0, 1), view.size - 1)));
    write_result(vec4(encodeSides(right, above)));
}
