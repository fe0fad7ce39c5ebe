// Ambient occlusion from horizons in slices through the line of sight (Jiménez et al. 2016).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"
#include "lib/occlusion.glsl"
#include "lib/slices.glsl"

// Horizons lower than this above the surface (sine) are what depths and normals are rounded to.
const float LEAST_RISE = 1e-4;

// Open part of one side of a slice, up to the highest thing within the radius.
float openSide(Slice s, ivec2 pixel, vec3 position, float side, float jitter) {
    float speed = length(s.onScreen);
    vec2 direction = s.onScreen * (side / max(speed, 1e-20));
    float farthest = marchLength(s, pixel, direction, speed, position, params.radius);
    float count = min(float(STEPS), max(ceil(farthest), 1.0));
    float horizon = LEAST_RISE;     // cosine to the normal's projection
#if FALLOFF != FALLOFF_NONE
    float open = openArc(s, side, horizon);
#endif
    for (float i = 0.0; i < count; ++i) {
        float reach = max(1.0, farthest * stepReach((i + jitter) / count, params.stepGrowth));
        ivec2 tap = tapAt(pixel, direction, reach);
        vec3 offset = viewPosition(tap, texelFetch(depth, tap, 0).r) - position;
        float squared = dot(offset, offset);
        vec2 at = inSlice(s, offset);
        // Without branches: what lies beyond the radius, the background as well, does not rise at all.
        float rise = squared <= params.radius * params.radius ? at.y * inversesqrt(max(dot(at, at), 1e-30)) : 0.0;
#if FALLOFF == FALLOFF_NONE
        horizon = max(horizon, rise);
#else
        if (rise <= horizon) continue;
        // What rises above the horizon so far hides the angles between, as much as its distance lets it.
        open -= falloffWeight(squared / (params.radius * params.radius)) * max(openArc(s, side, horizon) - openArc(s, side, min(rise, 1.0)), 0.0);
        horizon = rise;
#endif
    }
#if FALLOFF == FALLOFF_NONE
    return openArc(s, side, min(horizon, 1.0));
#else
    return open;
#endif
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float centre = texelFetch(depth, pixel, 0).r;
    if (isBackground(centre)) {
        write_result(vec4(1));
        return;
    }
    vec3 position = viewPosition(pixel, centre);
    vec3 surface = decodeNormal(texelFetch(normal, pixel * COARSENESS, 0).xy);
    SightFrame sight = sightFrame(position);
    vec2 random = evenlySpread(pixel);
    float open = 0.0, whole = 0.0;
    float first = random.x * (2.0 * HALF_PI / float(SLICES));
    vec2 turn = vec2(cos(first), sin(first));
    for (int i = 0; i < SLICES; ++i) {
        Slice s = sliceAt(sight, position, surface, turn);
        open += s.weight * (openSide(s, pixel, position, 1.0, random.y) + openSide(s, pixel, position, -1.0, 1.0 - random.y));
        whole += s.weight * (openArc(s, 1.0, LEAST_RISE) + openArc(s, -1.0, LEAST_RISE));
        turn = vec2(turn.x * params.turn.x - turn.y * params.turn.y, turn.x * params.turn.y + turn.y * params.turn.x);
    }
    float visible = clamp(open / max(whole, 1e-6), 0.0, 1.0);
    write_result(vec4(params.strength == 1.0 ? visible : pow(visible, params.strength)));
}
