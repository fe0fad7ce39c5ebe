// Joins the crossings on the sides of each cell (four pixels whose centres form a square; this pixel is the lower left)
// into pieces of line.
#include "lib/space.glsl"
#include "lib/lines.glsl"

struct Corner {
    vec2 place;
    uint code;
};  // a crossing on a side of the cell, in the cell's square of 1×1

Piece join(Corner a, Corner b) {
    // The owner's side of the piece: the pixel of the crossing's owner lies there.
    bool owner = ownedByOther(a.code);
    vec2 seen = a.place.y == 0.0 || a.place.y == 1.0 ? vec2(owner, a.place.y) : vec2(a.place.x, owner);
    vec2 along = b.place - a.place, off = seen - a.place;
    return Piece(a.place, b.place, a.code, along.x * off.y - along.y * off.x > 0.0);
}

#ifdef WITH_SEAMS
bool isSeam(ivec2 pixel) { return load(seams, clamp(pixel, ivec2(0), view.size - 1)).r > 0.0; }
#endif

// The crossings of a pixel's two ways. There are none to or from a pixel that looks into a seam.
uvec2 crossingsAt(ivec2 pixel) {
    bool outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, view.size));
    uvec2 found = load(crossings, clamp(pixel, ivec2(0), view.size - 1)).xy;
#ifdef WITH_SEAMS
    outside = outside || isSeam(pixel);
    found *= uvec2(!isSeam(pixel + ivec2(1, 0)), !isSeam(pixel + ivec2(0, 1)));
#endif
    return outside ? uvec2(0) : found;
}

// A crossing without a continuation on either side is a speck, not a line.
bool goesOn(ivec2 cell, bool viaBottom, bool viaRight, bool viaUpper) {
    ivec2 next = cell + (viaBottom ? ivec2(0, -1) : viaRight ? ivec2(1, 0) : viaUpper ? ivec2(0, 1) : ivec2(-1, 0));
    uvec2 own = crossingsAt(next);
    uint around = (viaUpper ? 0u : own.x) | (viaRight ? 0u : own.y);
    if (!(!viaBottom && !viaRight && !viaUpper)) around |= crossingsAt(next + ivec2(1, 0)).y;
    if (!viaBottom) around |= crossingsAt(next + ivec2(0, 1)).x;
    return around != 0u;
}

void main() {
    ivec2 cell = thisPixel();
    if (!insideRegion(cell) || IS_MASKED(cell)) return;
    uvec2 own = crossingsAt(cell);
    uint bottom = own.x, left = own.y, right = crossingsAt(cell + ivec2(1, 0)).y,
         upper = crossingsAt(cell + ivec2(0, 1)).x;
    int count = int(bottom != 0u) + int(right != 0u) + int(upper != 0u) + int(left != 0u);
    uvec4 pieces = uvec4(0);
    if (count > 0) {
        Corner b = Corner(vec2(placeOf(bottom), 0), bottom), r = Corner(vec2(1, placeOf(right)), right),
               u = Corner(vec2(placeOf(upper), 1), upper), l = Corner(vec2(0, placeOf(left)), left);
        Corner from, to, third;
        if (count == 4) {
            // Two lines cross.
            pieces.zw = encodePiece(join(l, r));
            from = b, to = u;
        } else if (count == 3) {
            // Goes round from the side without a crossing. The middle crossing lies opposite to it.
            Corner one = bottom == 0u ? r : right == 0u ? u : upper == 0u ? l : b;
            Corner middle = bottom == 0u ? u : right == 0u ? l : upper == 0u ? b : r;
            Corner other = bottom == 0u ? l : right == 0u ? b : upper == 0u ? r : u;
            // A line continues through the crossing of its own source, or straight on if sources decide nothing. The
            // third crossing's line ends on it.
            bool oneIsOdd = sourceOf(one.code) != sourceOf(other.code) && sourceOf(other.code) == sourceOf(middle.code);
            bool otherIsOdd = sourceOf(one.code) != sourceOf(other.code) && sourceOf(one.code) == sourceOf(middle.code);
            from = oneIsOdd ? middle : one;
            to = otherIsOdd ? middle : other;
            third = oneIsOdd ? one : otherIsOdd ? other : middle;
            vec2 along = to.place - from.place;
            vec2 end = from.place
                + along * clamp(dot(third.place - from.place, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
            pieces.zw = encodePiece(join(third, Corner(end, third.code)));
        } else {
            from = bottom != 0u ? b : right != 0u ? r : upper != 0u ? u : l;
            to = left != 0u ? l : upper != 0u ? u : right != 0u ? r : b;
            // A line ends in the middle of its last cell.
            if (count == 1) to.place = vec2(0.5);
        }
        if (count > 1 || goesOn(cell, bottom != 0u, right != 0u, upper != 0u))
            pieces.xy = withSecond(encodePiece(join(from, to)), count > 2);
    }
    write_first(uvec4(pieces.xy, 0u, 0u));
    write_second(uvec4(pieces.zw, 0u, 0u));
}
