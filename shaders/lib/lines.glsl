// The places of lines: between the centres of neighbouring pixels, known to a fraction of a pixel.
//
// Each pixel has two ways: to the pixel at its right (x) and to the one above it (y). For each it stores whether a line
// crosses it, where, and which line. Four pixels whose centres form a square make a cell. Crossings on the sides of a
// cell are joined into pieces of line.

// A technique's first result per pixel: five bits for the way to the right, five for the way up.
struct Side {
    uint source;        // the reason for the line; NO_SOURCE: no line
    bool ownedByOther;  // the line bounds the neighbour's visible surface, not this pixel's
    bool isEnd;         // the line's owner ends there, in front of something else or of nothing
};

uint encodeSide(Side s) { return s.source == 0u ? 0u : s.source | (uint(s.ownedByOther) << 3) | (uint(s.isEnd) << 4); }
uint encodeSides(Side right, Side above) { return encodeSide(right) | (encodeSide(above) << 5); }
// 0: to the right, 1: up.
Side decodeSide(uint sides, int direction) {
    uint code = (direction == 0 ? sides : sides >> 5) & 31u;
    return Side(code & 7u, (code & 8u) != 0u, (code & 16u) != 0u);
}

// One crossing, packed in 32 bits: place 8, source 3, record 8, thickness 6, strength 6, owner 1.
struct Crossing {
    float place;        // 0 at this pixel's centre, 1 at the neighbour's
    uint source;        // the reason for the line; NO_SOURCE: no line
    uint record;        // of the overrides that scenes give to objects and materials; 0: none
    float thickness;    // factor on the width
    float strength;     // factor on the opacity
    bool ownedByOther;  // the line bounds the neighbour's visible surface, not this pixel's
};

// A piece of a line that the scene draws itself, as src/effects/edges/marks.cpp packs it: whole numbers in floats. x
// and y: its ends, two times twelve bits. z: source 3, record 8, thickness 6, strength 6 bits; 0: there is none.
// Returns a crossing's code without place and owner.
uint codeOfMark(vec4 mark) {
    uint code = uint(mark.z);
    return ((code & 7u) << 8) | (((code >> 3) & 255u) << 11) | (((code >> 11) & 63u) << 19) | ((code >> 17) << 25);
}

vec2 endOfMark(float packed_) {
    uint both = uint(packed_);
    return vec2(both >> 12, both & 4095u) / 4095.0;
}

// Passes that include this define the numbers of sources, from 1: src/lines/sources.h.
const uint NO_SOURCE = 0u;

uint encodeCrossing(Crossing c) {
    if (c.source == NO_SOURCE) return 0u;
    return uint(clamp(c.place, 0.0, 1.0) * 255.0 + 0.5) | (c.source << 8) | (c.record << 11)
        | (uint(c.thickness * 63.0 + 0.5) << 19) | (uint(c.strength * 63.0 + 0.5) << 25) | (uint(c.ownedByOther) << 31);
}

uint sourceOf(uint code) { return (code >> 8) & 7u; }
uint recordOf(uint code) { return (code >> 11) & 255u; }
float placeOf(uint code) { return float(code & 255u) / 255.0; }
float thicknessOf(uint code) { return float((code >> 19) & 63u) / 63.0; }
float strengthOf(uint code) { return float((code >> 25) & 63u) / 63.0; }
bool ownedByOther(uint code) { return (code >> 31) != 0u; }

// A straight piece of line across a cell, in the cell's square of 1×1.
struct Piece {
    vec2 from, to;
    uint code;         // of the crossing that it begins at
    bool ownerIsLeft;  // the line's owner lies at its left, looking along it
};

// x: its ends, 8 bits each; never 0, since the ends lie on different sides, or one lies in the middle. y: its
// crossing's code, with ownerIsLeft in the owner's bit.
uvec2 encodePiece(Piece p) {
    uvec4 ends = uvec4(clamp(vec4(p.from, p.to), 0.0, 1.0) * 255.0 + 0.5);
    return uvec2(
        ends.x | (ends.y << 8) | (ends.z << 16) | (ends.w << 24), (p.code & 0x7fffffffu) | (uint(p.ownerIsLeft) << 31));
}

// A piece does not need the crossing's place: its lowest bit says whether the cell has a second piece.
uvec2 withSecond(uvec2 piece, bool has) { return uvec2(piece.x, (piece.y & ~255u) | uint(has)); }
bool hasSecond(uvec2 piece) { return (piece.y & 1u) != 0u; }

Piece decodePiece(uvec2 code) {
    vec4 ends = vec4(uvec4(code.x, code.x >> 8, code.x >> 16, code.x >> 24) & 255u) / 255.0;
    return Piece(ends.xy, ends.zw, code.y, ownedByOther(code.y));
}
