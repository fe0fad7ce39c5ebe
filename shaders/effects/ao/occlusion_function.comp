// Ambient occlusion by a function of depth differences (Schmitt 2008).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/random.glsl"

// The occlusion function between its 256 entries.
float occlusionOf(float difference) {
    if (difference <= 0.0 || difference >= 1.0) return 0.0;
    float at = difference * 255.0;
    int i = int(at), next = min(i + 1, 255);
    return mix(params.table[i / 4][i & 3], params.table[next / 4][next & 3], at - float(i));
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
    vec3 surface = decodeNormal(load(normal, pixel).xy);
    vec2 random = evenlySpread(pixel);
#ifdef OFFSET_IN_IMAGE
    float farthest = params.offset;
#else
    float farthest = min(params.radius / pixelFootprint(centre), 1e6);
#endif
    float hidden = 0.0;
    for (int i = 0; i < SAMPLES; ++i) {
        // The cardinal and intercardinal directions. The paper's random distances are drawn so that each direction gets
        // every distance in turn.
        float angle = 6.283185307 * (float(i) / float(SAMPLES));
        float reach = farthest * fract((i & 1) == 0 ? random.x + float(i) * 0.618034 : random.y + float(i) * 0.618034);
#ifdef OFFSET_IN_IMAGE
        ivec2 tap = clamp(pixelFrom(pixel, vec2(cos(angle), sin(angle)) * reach), ivec2(0), view.size - 1);
#else
        // Directions turn from pixel to pixel, since eight fixed ones draw stars.
        angle += random.y * 6.283185307 / float(SAMPLES);
        ivec2 tap = pixelFrom(pixel, vec2(cos(angle), sin(angle)) * max(reach, 1.0));
        if (!insideRegion(tap)) continue;
#endif
        if (tap == pixel) continue;
        float there = load(depth, tap).r;
#ifdef COMPARE_NORMALS
        if (dot(decodeNormal(load(normal, tap).xy), surface) > params.sameNormal) continue;
#else
        if (isBackground(there) || dot(viewPosition(tap, there) - position, surface) <= params.sameHeight) continue;
#endif
        hidden += occlusionOf((centre - there) * params.perDistance);
    }
    float visible = 1.0 - hidden / float(SAMPLES);
    write_result(vec4(params.strength == 1.0 ? visible : pow(max(visible, 0.0), params.strength)));
}
