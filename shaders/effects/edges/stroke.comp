// Draws lines of a width around their pieces: exact distances to pieces, one coverage per pixel.
#include "scene/scene.glsl"
#include "lib/space.glsl"
#include "lib/lines.glsl"

// The style of a source's lines: colour, and half of the width in pixels. An absent line takes the first style.
vec4 styleOf(uint source) {
#ifdef ONE_LOOK
    return params.styles[0];
#else
    return params.styles[max(int(source), 1) - 1];
#endif
}

// The share of a pixel on the near side of a straight line. The line lies at distance s from the pixel's centre,
// towards its far side. The pixel's projection onto the line's unit normal n is a trapezium; the share is the area of
// its part.
float shareWithin(float s, vec2 n) {
    vec2 side = abs(n);
    float longer = max(max(side.x, side.y), 0.7), shorter = max(min(side.x, side.y), 1e-4);
    float rest = max(0.5 * (longer + shorter) - abs(s), 0.0);
    float beyond = abs(s) < 0.5 * (longer - shorter) ? 0.5 - abs(s) / longer : rest * rest / (2.0 * longer * shorter);
    return s > 0.0 ? 1.0 - beyond : beyond;
}

// The coverage of a line whose nearest point lies `away` from the pixel's centre. The line is a band around its pieces,
// or beside them where it lies wholly inside or outside of its owner. The coverage is the band's area within the pixel:
// the right weight in every direction and at every width, also below a pixel.
float coverageOf(vec2 away, vec2 along, bool within, float halfWidth) {
    float distance = length(away);
    vec2 normal = distance > 1e-4 ? away / distance : vec2(-along.y, along.x) / max(length(along), 1e-3);
#ifdef ONE_SIDE
    float inside = within ? distance : -distance;
    vec2 band = 2.0 * halfWidth * (ONE_SIDE > 0 ? vec2(0, 1) : vec2(-1, 0));
#else
    float inside = distance;
    vec2 band = vec2(-halfWidth, halfWidth);
#endif
    return shareWithin(band.y - inside, normal) - shareWithin(band.x - inside, normal);
}

// A piece of line, relative to a pixel.
struct Seen {
    vec2 away, along;
    uint code;
    bool within;
};

Seen see(uvec2 code, vec2 fromCorner) {
    Piece piece = decodePiece(code);
    vec2 along = piece.to - piece.from, off = fromCorner - piece.from;
    float squared = dot(along, along);
    // A piece of no length has no direction; its neighbours cover for it. An absent piece has no length either.
    if (squared == 0.0) off = vec2(1e4);
    return Seen(off - clamp(dot(off, along) / max(squared, 1e-6), 0.0, 1.0) * along, along, piece.code,
        (along.x * off.y - along.y * off.x > 0.0) == piece.ownerIsLeft);
}

#ifdef WITH_MARKS
// A mark has no sides: it is drawn on both.
Seen seeMark(vec4 mark, vec2 fromCorner) {
    vec2 from = endOfMark(mark.x), along = endOfMark(mark.y) - from, off = fromCorner - from;
    float squared = dot(along, along);
    if (mark.z == 0.0) off = vec2(1e4);
    return Seen(off - clamp(dot(off, along) / max(squared, 1e-9), 0.0, 1.0) * along, along, codeOfMark(mark), true);
}
#endif

// The inks on the pixel: colour and opacity.
vec4 top = vec4(0), rest = vec4(0);

#ifdef ONE_COLOR
// All lines have one colour: the one that reaches farthest over the pixel decides.
Seen best;
float farthest = -1e9, bestHalf = 0.0;

void add(Seen seen) {
    float halfWidth = styleOf(sourceOf(seen.code)).a * thicknessOf(seen.code), reach = halfWidth - length(seen.away);
    if (reach > farthest) best = seen, farthest = reach, bestHalf = halfWidth;
}

void finish() {
    if (farthest > -2.0)
        top = vec4(
            params.styles[0].rgb, coverageOf(best.away, best.along, best.within, bestHalf) * strengthOf(best.code));
}
#else
float topWidth = 0.0;

// The widest line lies on top. Among pieces of one line the strongest counts, since they join.
void add(Seen seen) {
    float halfWidth = styleOf(sourceOf(seen.code)).a;
    vec4 ink = vec4(styleOf(sourceOf(seen.code)).rgb,
        coverageOf(seen.away, seen.along, seen.within, halfWidth * thicknessOf(seen.code)) * strengthOf(seen.code));
#ifdef WITH_RECORDS
    LineRecord own = lineRecordAt(recordOf(seen.code));
    if (own.hasColor) ink.rgb = own.color;
#endif
    bool same = halfWidth == topWidth && ink.rgb == top.rgb, wider = ink.a > 0.0 && halfWidth > topWidth;
    vec4 below = wider ? top : ink;
    if (!same && below.a > rest.a) rest = below;
    if (wider || (same && ink.a > top.a)) top = ink;
    if (wider) topWidth = halfWidth;
}

void finish() {}
#endif

// Cells whose pieces may reach a pixel, row by row.
ivec2 cellNear(ivec2 pixel, int i) {
    return clamp(pixel + ivec2(i % (2 * WINDOW), i / (2 * WINDOW)) - WINDOW, ivec2(0), view.size - 1);
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel) || IS_MASKED(pixel)) return;
    // Pieces lie on the grid of this sample's points. Coverage counts from the middle of the pixel, so that all samples
    // agree.
    vec2 here = -view.samplePlace;
    // Few of the cells around have a piece. Finding them first lets pixels that are drawn together loop over as many
    // pieces as one of them has, not over all cells.
    for (int begin = 0; begin < WINDOW * WINDOW * 4; begin += 32) {
        uint occupied = 0u;
        for (int i = 0; i < min(32, WINDOW * WINDOW * 4 - begin); ++i)
            occupied |= uint(load(first, cellNear(pixel, begin + i)).x != 0u) << i;
        bool beside = false;  // is a cell's second piece next?
        do {
            ivec2 cell = cellNear(pixel, begin + max(findLSB(occupied), 0));
            uvec2 one = load(first, cell).xy, two = load(second, cell).xy;
            add(see(beside ? two : one, here - vec2(cell - pixel)));
            beside = !beside && hasSecond(one);
            if (!beside) occupied &= occupied - 1u;
        } while (occupied != 0u);
    }
#ifdef WITH_MARKS
    for (int i = 0; i < WINDOW * WINDOW * 4; ++i) {
        ivec2 cell = cellNear(pixel, i);
        vec4 one = load(marks, cell), two = load(marksBeside, cell);
        if (one.z + two.z == 0.0) continue;
        add(seeMark(one, here - vec2(cell - pixel)));
        add(seeMark(two, here - vec2(cell - pixel)));
    }
#endif
    finish();
    vec4 color = params.opacity * (vec4(top.rgb, 1) * top.a + (1.0 - top.a) * rest.a * vec4(rest.rgb, 1));
#ifdef LAYERS_BELOW
    color += load(layersBelow, pixel) * (1.0 - color.a);
#endif
    write_result(color);
}
