// Ambient occlusion from points in the hemisphere over each pixel (Lawonn's lecture).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"
#include "lib/occlusion.glsl"
#include "lib/points.glsl"

// Two directions that complete the normal to a basis, turned by a random vector (Gram and Schmidt); one of the axes
// helps out where the random vector is parallel to the normal.
mat3 turnedBasis(vec3 normal, vec3 random) {
    vec3 tangent = random - normal * dot(random, normal);
    if (dot(tangent, tangent) < 1e-6) {
        vec3 axis = abs(normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        tangent = axis - normal * dot(axis, normal);
    }
    tangent = normalize(tangent);
    return mat3(tangent, cross(normal, tangent), normal);
}

vec3 turnOf(ivec2 pixel) {
#ifdef TILED_TURN
    ivec3 at = sampleOf(pixel);
    ivec2 cell = at.xy - at.xy / params.noiseSize * params.noiseSize;
    cell += ivec2(lessThan(cell, ivec2(0))) * params.noiseSize;
    uint number = uint(cell.y * params.noiseSize + cell.x) + uint(at.z) * 4099u + view.seed * 65537u;
    return vec3(unitFloat(mixBits(number * 2u)) * 2.0 - 1.0, unitFloat(mixBits(number * 2u + 1u)) * 2.0 - 1.0, 0.0);
#else
    float angle = 6.283185307 * evenlySpread(pixel).x;
    return vec3(cos(angle), sin(angle), 0.0);
#endif
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float centre = load(depth, pixel).r;
    if (isBackground(centre)) {
        write_result(vec4(1));
        return;
    }
    vec3 position = viewPosition(pixel, centre);
    vec3 surface = decodeNormal(load(normal, pixel * COARSENESS).xy);
    mat3 basis = turnedBasis(surface, turnOf(pixel));
    float squaredRadius = params.radius * params.radius, hidden = 0.0;
    for (int i = 0; i < POINT_COUNT; ++i) {
        vec3 offset = basis * params.kernelPoints[i].xyz * params.radius;
        vec3 point = position + offset;
        // A point behind the eye falls on no pixel.
        if (!ORTHOGRAPHIC && point.z > -1e-3 * centre) continue;
        ivec2 tap = pixelOf(point);
#ifdef CLAMP_TAPS
        tap = clamp(tap, ivec2(0), (view.size - 1) / COARSENESS);
#else
        if (!insideRegion(tap)) continue;
#endif
        if (tap == pixel) continue;
        float there = load(depth, tap).r;
#ifdef COMPARE_HEIGHT
        float compared = depthAtHeight(tap, position, surface, dot(offset, surface));
#else
        float compared = -point.z;
#endif
        float isHidden = there < compared * (1.0 - DEPTH_SLACK) - params.bias ? 1.0 : 0.0;
#ifdef RANGE_CHECK
        isHidden *= smoothstep(0.0, 1.0, params.radius / max(abs(centre - there), 1e-20));
#endif
#if FALLOFF != FALLOFF_NONE
        vec3 occluder = viewPosition(tap, there) - position;
        isHidden *= falloffWeight(min(dot(occluder, occluder) / squaredRadius, 1.0));
#endif
        hidden += isHidden;
    }
    float visible = 1.0 - hidden / float(POINT_COUNT);
    write_result(vec4(params.power == 1.0 ? visible : pow(max(visible, 0.0), params.power)));
}
