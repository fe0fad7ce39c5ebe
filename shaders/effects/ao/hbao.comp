// Ambient occlusion from the horizons of the depth image (Bavoil & Sainz 2008).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"
#include "lib/occlusion.glsl"
#include "lib/slices.glsl"
#include "effects/ao/horizon.glsl"

#ifdef UNIFORM_WEIGHT
// Hidden part along one direction: sin h − sin t, where h is the highest rise of the depth image above the picture's
// plane and t that of the surface itself, raised by the bias. Each higher rise counts with the falloff of its own
// distance.
float hiddenAlong(ivec2 pixel, vec2 direction, vec3 position, vec3 normal, float jitter) {
    float farthest = params.radius / pixelFootprint(-position.z);
    float count = min(float(STEPS), max(ceil(farthest), 1.0));
    // The surface's own rise: a step (direction, z) stays on the surface if it is perpendicular to the normal. z is
    // towards the viewer.
    float rise = -dot(normal.xy, direction) / max(normal.z, 1e-4);
    float cosT = inversesqrt(1.0 + rise * rise), sinT = rise * cosT;
    float lowest = sinT * params.cosBias + cosT * params.sinBias;  // sin(t + bias)
    if (cosT * params.cosBias - sinT * params.sinBias <= 0.0)
        return 0.0;  // biased past the zenith: nothing can rise above
    float highest = lowest, hidden = 0.0;
    for (float i = 0.0; i < count; ++i) {
        float reach = max(1.0, farthest * stepReach((i + jitter) / count, params.stepGrowth));
        ivec2 tap = pixelFrom(pixel, direction * reach);
#ifdef CLAMP_TAPS
        tap = clamp(tap, ivec2(0), (view.size - 1) / COARSENESS);
#else
        if (!insideRegion(tap)) continue;
#endif
        if (tap == pixel) continue;
        vec3 offset = viewPosition(tap, load(depth, tap).r) - position;
        float squared = dot(offset, offset);
        if (squared > params.radius * params.radius) continue;
        float sinH = offset.z * inversesqrt(max(squared, 1e-30));
        if (sinH > highest) {
            hidden += falloffWeight(squared / (params.radius * params.radius)) * (sinH - highest);
            highest = sinH;
        }
    }
    return hidden;
}
#endif

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
    vec2 random = evenlySpread(pixel);
    float first = random.x * (4.0 * HALF_PI / float(DIRECTIONS));
    vec2 turn = vec2(cos(first), sin(first));
#ifdef UNIFORM_WEIGHT
    float hidden = 0.0;
#else
    SightFrame sight = sightFrame(position);
    float open = 0.0, whole = 0.0;
#endif
    for (int i = 0; i < DIRECTIONS; ++i) {
        // Directions start at different places, since their rings would show otherwise.
        float jitter = fract(random.y + float(i) * 0.618034);
#ifdef UNIFORM_WEIGHT
        hidden += hiddenAlong(pixel, turn, position, surface, jitter);
#else
        Slice s = sliceAt(sight, position, surface, turn);
        open += s.weight * openSide(s, pixel, position, 1.0, params.sinBias, jitter);
        whole += s.weight * openArc(s, 1.0, params.sinBias);
#endif
        turn = vec2(turn.x * params.turn.x - turn.y * params.turn.y, turn.x * params.turn.y + turn.y * params.turn.x);
    }
#ifdef UNIFORM_WEIGHT
    float visible = clamp(1.0 - hidden / float(DIRECTIONS), 0.0, 1.0);
#else
    float visible = clamp(open / max(whole, 1e-6), 0.0, 1.0);
#endif
    write_result(vec4(params.strength == 1.0 ? visible : pow(visible, params.strength)));
}
