// Finds the exact places of the lines that a technique has found between pixels.
#include "scene/scene.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/lines.glsl"
#ifdef WITH_TRIANGLES
#ifdef CUTOUTS
#include "lib/texture.glsl"
#endif
#include "effects/edges/spans.glsl"
#endif

struct Surface {
    ivec2 pixel;
    float depth;
    vec3 position, face;  // view space; face: normal of the triangle
};

Surface surfaceAt(ivec2 pixel) {
    float z = load(depth, pixel).r;
    return Surface(
        pixel, z, viewPosition(pixel, isBackground(z) ? 0.0 : z), decodeNormal(load(normalGeometric, pixel).xy));
}

// The place on the way from a's pixel to b's where the planes of two surfaces meet; 0.5 if they meet elsewhere or not
// at all.
float meetingPlace(Surface a, Surface b) {
    // The planes' difference at a and at b, in the quantity that is linear in the picture: 1/depth or depth.
    float atA, atB;
    if (ORTHOGRAPHIC) {
        vec2 way = b.position.xy - a.position.xy;
        atA = b.depth - dot(b.face.xy, way) / b.face.z - a.depth;
        atB = b.depth - a.depth - dot(a.face.xy, way) / a.face.z;
    } else {
        vec3 rayA = a.position / a.depth, rayB = b.position / b.depth;
        atA = 1.0 / a.depth - dot(b.face, rayA) / dot(b.face, b.position);
        atB = dot(a.face, rayB) / dot(a.face, a.position) - 1.0 / b.depth;
    }
    return atA * atB < 0.0 ? atA / (atA - atB) : 0.5;
}

uint crossingBetween(Surface a, Surface b, Side side) {
    if (side.source == NO_SOURCE) return 0u;
    bool bIsNearer = b.depth < a.depth;
    float place = 0.5;
    bool meets = !side.isEnd && dot(a.face, b.face) < 0.9999;
    if (meets) place = meetingPlace(a, b);
#ifdef WITH_TRIANGLES
    ivec2 way = b.pixel - a.pixel;
    float reach = reachOf(bIsNearer ? b.pixel : a.pixel, bIsNearer ? -way : way, side.isEnd);
    if (!meets) place = bIsNearer ? 1.0 - reach : reach;
#endif
    uint record = 0u;
#ifdef WITH_RECORDS
    record = load(lineRecord, side.ownedByOther ? b.pixel : a.pixel).r;
#endif
    float far = clamp((min(a.depth, b.depth) - params.fadeFrom) * params.fadeScale, 0.0, 1.0);
    return encodeCrossing(
        Crossing(place, side.source, record, 1.0 - params.taper * far, 1.0 - params.fade * far, side.ownedByOther));
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel) || IS_MASKED(pixel)) return;
    uint found = load(sides, pixel).r;
    Surface here = surfaceAt(pixel);
    // Few pixels have a line on both ways. Pixels that are drawn together loop only as often as one of them needs.
    uvec2 crossings = uvec2(0);
    uint pending =
        uint(decodeSide(found, 0).source != NO_SOURCE) | (uint(decodeSide(found, 1).source != NO_SOURCE) << 1);
    do {
        int direction = (pending & 1u) != 0u ? 0 : 1;
        ivec2 way = direction == 0 ? ivec2(1, 0) : ivec2(0, 1);
        uint crossing = crossingBetween(here, surfaceAt(min(pixel + way, view.size - 1)), decodeSide(found, direction));
        if (direction == 0)
            crossings.x = crossing;
        else
            crossings.y = crossing;
        pending &= pending - 1u;
    } while (pending != 0u);
    write_result(uvec4(crossings, 0u, 0u));
}
