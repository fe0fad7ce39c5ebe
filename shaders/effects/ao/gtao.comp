// Ambient occlusion from horizons in slices through the line of sight (Jiménez et al. 2016).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"
#include "lib/occlusion.glsl"
#include "lib/slices.glsl"
#include "effects/ao/horizon.glsl"

// Horizons below this (sine above the surface) are rounding of depths and normals.
const float LEAST_RISE = 1e-4;

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
        open += s.weight
            * (openSide(s, pixel, position, 1.0, LEAST_RISE, random.y)
                + openSide(s, pixel, position, -1.0, LEAST_RISE, 1.0 - random.y));
        whole += s.weight * (openArc(s, 1.0, LEAST_RISE) + openArc(s, -1.0, LEAST_RISE));
        turn = vec2(turn.x * params.turn.x - turn.y * params.turn.y, turn.x * params.turn.y + turn.y * params.turn.x);
    }
    float visible = clamp(open / max(whole, 1e-6), 0.0, 1.0);
    write_result(vec4(params.strength == 1.0 ? visible : pow(visible, params.strength)));
}
