// Lines where depth or normal jump between a pixel and one of eight others half a line width away.
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"

const vec2 DIRECTIONS[8] = vec2[](vec2(-1, -1), vec2(0, -1), vec2(1, -1), vec2(-1, 0), vec2(1, 0), vec2(-1, 1), vec2(0, 1), vec2(1, 1));

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
    // Neighbours are whole pixels: a reach between two of them is reached on average over the samples.
    float reach = floor(params.reach + evenlySpread(pixel).x);
    bool line = false;
    for (int i = 0; i < 8; ++i) {
        ivec2 other = clamp(pixel + ivec2(DIRECTIONS[i] * reach), ivec2(0), view.size - 1);
        line = isLine(here, surfaceAt(other)) || line;
    }
    vec4 color = line ? params.color : vec4(0);
#ifdef LAYERS_BELOW
    color += texelFetch(layersBelow, pixel, 0) * (1.0 - color.a);
#endif
    write_result(color);
}
