// The horizon of the depth image along a slice. For techniques that define STEPS and whose params have radius and
// stepGrowth. Include after lib/occlusion.glsl and lib/slices.glsl.

// Open part of one side of a slice (side: 1 or -1), up to the highest thing within the radius that rises more than
// `leastRise` (sine) above the surface.
float openSide(Slice s, ivec2 pixel, vec3 position, float side, float leastRise, float jitter) {
    float speed = length(s.onScreen);
    vec2 direction = s.onScreen * (side / max(speed, 1e-20));
    float farthest = marchLength(s, pixel, direction, speed, position, params.radius);
    float count = min(float(STEPS), max(ceil(farthest), 1.0));
    float horizon = leastRise;  // cosine to the normal's projection
#if FALLOFF != FALLOFF_NONE
    float open = openArc(s, side, horizon);
#endif
    for (float i = 0.0; i < count; ++i) {
        float reach = max(1.0, farthest * stepReach((i + jitter) / count, params.stepGrowth));
        ivec2 tap = tapAt(pixel, direction, reach);
        vec3 offset = viewPosition(tap, load(depth, tap).r) - position;
        float squared = dot(offset, offset);
        vec2 at = inSlice(s, offset);
        // Without branches: taps beyond the radius, and the background, have no rise.
        float rise = squared <= params.radius * params.radius ? at.y * inversesqrt(max(dot(at, at), 1e-30)) : 0.0;
#if FALLOFF == FALLOFF_NONE
        horizon = max(horizon, rise);
#else
        if (rise <= horizon) continue;
        // A rise above the horizon so far hides the angles between, with the falloff of its distance.
        open -= falloffWeight(squared / (params.radius * params.radius))
            * max(openArc(s, side, horizon) - openArc(s, side, min(rise, 1.0)), 0.0);
        horizon = rise;
#endif
    }
#if FALLOFF == FALLOFF_NONE
    return openArc(s, side, min(horizon, 1.0));
#else
    return open;
#endif
}
