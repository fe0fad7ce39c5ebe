// Ambient occlusion from a few points around each pixel (Lajzer & Nottingham, pass 2).
#include "lib/space.glsl"
#include "lib/random.glsl"
#include "lib/points.glsl"
#ifdef HEMISPHERE
#include "lib/normals.glsl"
#endif

// The hidden share of a kernel point: 0 or 1, less where the occluder is in front by more than the radius. It has no
// branches, so that software renderers need no loop for it.
// `perReach`: 1 over the radius in the same units as depths.
float hiddenAt(vec3 kernelPoint, ivec2 pixel, float centre, vec3 position, vec3 mirror, vec3 surface, float perReach) {
    vec3 offset = reflect(kernelPoint, mirror);
    float height = dot(offset, surface);
#ifdef HEMISPHERE
    offset = height < 0.0 ? -offset : offset;
    height = abs(height);
#endif
#ifdef RADIUS_IN_IMAGE
    ivec2 tap = clamp(pixelFrom(pixel, offset.xy * params.radiusPixels), ivec2(0), view.size - 1);
    bool counts = tap != pixel;
#else
    vec3 point = position + offset * params.radius;
    // A point behind the eye falls on no pixel.
    bool isBefore = ORTHOGRAPHIC || point.z <= -1e-3 * centre;
    ivec2 tap = pixelOf(vec3(point.xy, isBefore ? point.z : -centre));
    bool counts = isBefore && insideRegion(tap) && tap != pixel;
#endif
    float there = load(depth, tap).r;
#if defined(POINT_DEPTH) && !defined(RADIUS_IN_IMAGE)
    bool isHidden = there < depthAtHeight(tap, position, surface, height * params.radius) * (1.0 - DEPTH_SLACK);
#else
    bool isHidden = there < centre * (1.0 - DEPTH_SLACK);
#endif
    float share = isHidden && counts ? 1.0 : 0.0;
#ifdef RANGE_CHECK
    // Full within the radius, gone at twice the radius.
    share *= clamp(2.0 - (centre - there) * perReach, 0.0, 1.0);
#endif
    return share;
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
    vec3 mirror = onSphere(evenlySpread(pixel));
#ifdef HEMISPHERE
    vec3 surface = decodeNormal(load(normal, pixel).xy);
#else
    vec3 surface = vec3(0, 0, 1);
#endif
#ifdef RADIUS_IN_IMAGE
    float perReach = 1.0 / (params.radiusPixels * pixelFootprint(centre));
#else
    float perReach = 1.0 / params.radius;
#endif
    // The kernel's points are part of the code, since software renderers read a list as slowly as an image.
#define HIDDEN(point) hiddenAt(point, pixel, centre, position, mirror, surface, perReach)
    float hidden = SUM_OVER_KERNEL(HIDDEN);
    float share = hidden < float(params.deadZone) ? 0.0 : hidden / float(POINT_COUNT);
#ifdef QUADRATIC
    share *= share;
#endif
    float open = 1.0 - share;
    write_result(vec4(params.strength == 1.0 ? open : pow(max(open, 0.0), params.strength)));
}
