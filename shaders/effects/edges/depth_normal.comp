// Lines where depth or normal jump between a pixel and one of eight others half a line width away.
#include "lib/space.glsl"
#include "lib/random.glsl"

const vec2 DIRECTIONS[8] = vec2[](vec2(-1, -1), vec2(0, -1), vec2(1, -1), vec2(-1, 0), vec2(1, 0), vec2(-1, 1), vec2(0, 1), vec2(1, 1));

#ifdef PROJECTED_DEPTH
// Standard depth: 0 at near, 1 at far.
float projected(float z) {
    if (isBackground(z)) return 1.0;
    return view.orthographic ? (z - params.near) / (params.far - params.near) : params.far / (params.far - params.near) * (1.0 - params.near / z);
}
#endif

bool isLine(ivec2 pixel, ivec2 other, float z, vec3 n) {
    float otherZ = texelFetch(depth, other, 0).r;
    vec3 otherN = texelFetch(normal, other, 0).xyz;
#ifdef PROJECTED_DEPTH
    if (abs(projected(otherZ) - projected(z)) > params.depthThreshold * (1.0 - projected(z))) return true;
    if (isBackground(z) || isBackground(otherZ)) return isBackground(z) != isBackground(otherZ);
    return dot(n, otherN) < params.cosine;
#else
    if (isBackground(z) || isBackground(otherZ)) return isBackground(z) != isBackground(otherZ);
    if (dot(n, otherN) < params.cosine) return true;
    vec3 between = viewPosition(other, otherZ) - viewPosition(pixel, z);
    float distance = max(abs(dot(between, texelFetch(normalGeometric, pixel, 0).xyz)), abs(dot(between, texelFetch(normalGeometric, other, 0).xyz)));
    return distance > params.step * pixelFootprint(min(z, otherZ));
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!insideRegion(pixel)) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 n = texelFetch(normal, pixel, 0).xyz;
    // Neighbours are whole pixels: a reach between two of them is reached on average over the samples.
    float reach = floor(params.reach + evenlySpread(pixel).x);
    bool line = false;
    for (int i = 0; i < 8; ++i) {
        ivec2 other = clamp(pixel + ivec2(round(DIRECTIONS[i] * reach)), ivec2(0), view.size - 1);
        line = line || isLine(pixel, other, z, n);
    }
    vec4 color = line ? params.color : vec4(0);
#ifdef LAYERS_BELOW
    color += texelFetch(layersBelow, pixel, 0) * (1.0 - color.a);
#endif
    imageStore(result, pixel, color);
}
