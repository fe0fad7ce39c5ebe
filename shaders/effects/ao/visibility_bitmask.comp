// Ambient occlusion from bitmasks of hidden sectors in slices through the line of sight (Therrien et al. 2023).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"
#include "lib/occlusion.glsl"
#include "lib/slices.glsl"

const float SECTORS = 32.0;

// Rises below this (sine above the surface) are rounding of depths and normals.
const float LEAST_RISE = 1e-4;

// Share of a slice's measure, 0 … 1, between its lower end and the direction to a point of the slice (inSlice).
float shareBelow(Slice s, vec2 at) {
    vec2 d = at * inversesqrt(max(dot(at, at), 1e-30));     // sine and cosine of the angle to the normal's projection
    d = d.y > 0.0 ? d : vec2(d.x < 0.0 ? -1.0 : 1.0, 0.0);  // below the surface
    float away = asinSigned(d.x);
#ifdef EQUAL_ANGLES
    return away / (2.0 * HALF_PI) + 0.5;
#else
    // The integral of cos(angle − n)·|sin angle| from the line of sight, signed; over everything it is cos n + n·sin n.
    float angle = s.angleN + away;
    float cosTwice = d.y * d.y - d.x * d.x, sinTwice = 2.0 * d.x * d.y;  // of 2·away
    float arc = 0.25 * (s.cosN + 2.0 * angle * s.sinN - (cosTwice * s.cosN - sinTwice * s.sinN));
    float lower = 0.25 * (2.0 * s.cosN + 2.0 * (s.angleN - HALF_PI) * s.sinN);
    return clamp(((angle < 0.0 ? -arc : arc) + lower) / max(s.cosN + s.angleN * s.sinN, 1e-6), 0.0, 1.0);
#endif
}

// Bits of the sectors between two shares; a partly covered sector counts with that probability.
uint sectorsBetween(float a, float b, float dither) {
    float first = floor(min(a, b) * SECTORS + dither), last = floor(max(a, b) * SECTORS + dither);
    uint count = uint(clamp(last - first, 0.0, SECTORS)), from = uint(clamp(first, 0.0, SECTORS - 1.0));
    return count == 0u ? 0u : (0xffffffffu >> (32u - count)) << from;
}

#ifdef JOIN
struct Tap {
    vec3 offset, normal;
    vec2 at;                     // inSlice
    float share;                 // shareBelow
    bool exists, isNear, rises;  // near: within the radius; rises: above the surface, beyond rounding
};

// The crossing of the radius on the way from a point within it to one beyond.
vec2 crossing(vec2 inside, vec2 outside) {
    vec2 way = outside - inside;
    float a = max(dot(way, way), 1e-30), b = dot(inside, way),
          c = min(dot(inside, inside) - params.radius * params.radius, 0.0);
    return inside + way * ((sqrt(b * b - a * c) - b) / a);
}
#endif

// Adds the sectors that one side of a slice hides.
void march(
    inout uint hidden, Slice s, ivec2 pixel, vec3 position, vec3 surface, float side, float jitter, float dither) {
    float speed = length(s.onScreen);
    vec2 direction = s.onScreen * (side / max(speed, 1e-20));
    float farthest = marchLength(s, pixel, direction, speed, position, params.radius);
    float count = min(float(STEPS), max(ceil(farthest), 1.0));
    float squaredRadius = params.radius * params.radius;
#ifdef JOIN
    // The point itself, slightly to the side, so that it has a direction.
    Tap before =
        Tap(vec3(0), surface, vec2(side * 1e-6 * params.radius, 0.0), side < 0.0 ? 0.0 : 1.0, true, true, false);
    float reachBefore = 0.0;
#endif
    for (float i = 0.0; i < count; ++i) {
        float reach = max(1.0, farthest * stepReach((i + jitter) / count, params.stepGrowth));
        ivec2 tap = pixelFrom(pixel, direction * reach);
        if (tap == pixel || !insideRegion(tap)) continue;
        float there = load(depth, tap).r;
        vec3 offset = viewPosition(tap, there) - position;
        bool exists = !isBackground(there);
        vec2 at = inSlice(s, offset);
        float squared = dot(offset, offset), share = shareBelow(s, at);
        bool isNear = exists && squared <= squaredRadius;
#if FALLOFF != FALLOFF_NONE
        isNear = isNear && fract(dither + i * 0.618034) < falloffWeight(squared / squaredRadius);
#endif
        bool rises = at.y > 0.0 && at.y * at.y > LEAST_RISE * LEAST_RISE * dot(at, at);
#ifdef THICK
        if (isNear && rises) {
            vec3 behind = offset + (ORTHOGRAPHIC ? vec3(0, 0, -1) : normalize(position + offset)) * params.thickness;
            hidden |= sectorsBetween(share, shareBelow(s, inSlice(s, behind)), dither);
        }
#endif
#ifdef JOIN
        vec3 face = exists ? decodeNormal(load(normal, tap * COARSENESS).xy) : vec3(0);
        if (exists && before.exists && (isNear || before.isNear)) {
            // Neighbours lie on one surface, or on two that meet, if one lies near the other's tangent plane. Longer
            // steps may lie farther off it, but not in proportion: that would join things that are only near each other
            // in the picture.
            vec3 way = offset - before.offset;
            float allowed = params.joinWithin * sqrt(max(reach - reachBefore, 1.0))
                * pixelFootprint(min(there, -position.z - before.offset.z));
            if (min(abs(dot(way, face)), abs(dot(way, before.normal))) <= allowed && (rises || before.rises)) {
                float from = before.share, to = share;
                if (!isNear) to = shareBelow(s, crossing(before.at, at));
                if (!before.isNear) from = shareBelow(s, crossing(at, before.at));
                hidden |= sectorsBetween(from, to, dither);
            }
        }
        before = Tap(offset, face, at, share, exists, isNear, rises);
        reachBefore = reach;
#endif
    }
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
    SightFrame sight = sightFrame(position);
    vec2 random = evenlySpread(pixel);
    float open = 0.0, whole = 0.0;
    float first = random.x * (2.0 * HALF_PI / float(SLICES));
    vec2 turn = vec2(cos(first), sin(first));
    for (int i = 0; i < SLICES; ++i) {
        Slice s = sliceAt(sight, position, surface, turn);
        uint hidden = 0u;
        float dither = fract(random.x + random.y + float(i) * 0.618034);
        march(hidden, s, pixel, position, surface, 1.0, random.y, dither);
        march(hidden, s, pixel, position, surface, -1.0, 1.0 - random.y, dither);
        float measure = s.weight * (s.cosN + s.angleN * s.sinN);
        open += measure * (1.0 - float(bitCount(hidden)) / SECTORS);
        whole += measure;
        turn = vec2(turn.x * params.turn.x - turn.y * params.turn.y, turn.x * params.turn.y + turn.y * params.turn.x);
    }
    float visible = clamp(open / max(whole, 1e-6), 0.0, 1.0);
    write_result(vec4(params.strength == 1.0 ? visible : pow(visible, params.strength)));
}
