// Ambient occlusion from a few points around each pixel (Lajzer & Nottingham, pass 2).
#include "lib/space.glsl"
#include "lib/random.glsl"
#include "lib/points.glsl"
#ifdef HEMISPHERE
#include "lib/normals.glsl"
#endif

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float centre = texelFetch(depth, pixel, 0).r;
    if (isBackground(centre)) {
        write_result(vec4(1));
        return;
    }
    vec3 position = viewPosition(pixel, centre);
    vec3 mirror = onSphere(evenlySpread(pixel));
#ifdef HEMISPHERE
    vec3 surface = decodeNormal(texelFetch(normal, pixel, 0).xy);
#else
    vec3 surface = vec3(0, 0, 1);
#endif
    float hidden = 0.0;
    for (int i = 0; i < POINT_COUNT; ++i) {
        vec3 offset = reflect(params.kernelPoints[i].xyz, mirror);
#ifdef HEMISPHERE
        offset = dot(offset, surface) < 0.0 ? -offset : offset;
#endif
#ifdef RADIUS_IN_IMAGE
        ivec2 tap = clamp(pixelFrom(pixel, offset.xy * params.radiusPixels), ivec2(0), view.size - 1);
        vec3 point = position;
        float reach = params.radiusPixels * pixelFootprint(centre);
#else
        vec3 point = position + offset * params.radius;
        // A point behind the eye falls on no pixel.
        if (!view.orthographic && point.z > -1e-3 * centre) continue;
        ivec2 tap = pixelOf(point);
        float reach = params.radius;
        if (!insideRegion(tap)) continue;
#endif
        if (tap == pixel) continue;
        float there = texelFetch(depth, tap, 0).r;
#if defined(POINT_DEPTH) && !defined(RADIUS_IN_IMAGE)
        float compared = depthAtHeight(tap, position, surface, dot(point - position, surface));
#else
        float compared = centre;
#endif
        float isHidden = there < compared * (1.0 - DEPTH_SLACK) ? 1.0 : 0.0;
#ifdef RANGE_CHECK
        // Full within the radius, gone at twice the radius.
        isHidden *= clamp(2.0 - (centre - there) / reach, 0.0, 1.0);
#endif
        hidden += isHidden;
    }
    float share = hidden < float(params.deadZone) ? 0.0 : hidden / float(POINT_COUNT);
#ifdef QUADRATIC
    share *= share;
#endif
    float open = 1.0 - share;
    write_result(vec4(params.strength == 1.0 ? open : pow(max(open, 0.0), params.strength)));
}
