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

#ifdef WITH_TRIANGLES
// A gap narrower than this, in pixels, is a seam of one surface: it is seen by chance, in a row of dots.
const float SEAM = 0.1;

bool isOnPlaneOf(Surface one, Surface other) {
    return !isBackground(one.depth) && dot(one.face, other.face) > 0.9999
        && abs(dot(one.position - other.position, other.face)) < 0.5 * pixelFootprint(other.depth);
}

// Does a pixel look into a seam? On both sides of it, along x or y, the same plane goes on, up to places that are that
// close. (Where triangles beside the visible ones reach the seam, it stays a line.)
bool isSeam(Surface s) {
    uint pending = 0u;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 way = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        Surface before = surfaceAt(max(s.pixel - way, ivec2(0))), after = surfaceAt(min(s.pixel + way, view.size - 1));
        bool mayBe = !isBackground(before.depth) && isOnPlaneOf(after, before) && !isOnPlaneOf(s, before);
        pending |= uint(mayBe) << axis;
    }
    bool found = false;
    while (pending != 0u) {
        ivec2 way = (pending & 1u) != 0u ? ivec2(1, 0) : ivec2(0, 1), before = s.pixel - way, after = s.pixel + way;
        float reach = spanOf(triangleOf(seenAt(before)), before, way).y,
              reachBack = spanOf(triangleOf(seenAt(after)), after, -way).y;
        // Where something lies in front, the plane goes on behind it.
        bool bothEnd = max(reach, reachBack) < 1.001;
        found = found || (bothEnd && 2.0 - reach - reachBack < SEAM);
        pending &= pending - 1u;
    }
    return found;
}
#endif

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
#ifdef WITH_TRIANGLES
    write_seams(vec4(isSeam(here) ? 1.0 : 0.0));
#endif
}
