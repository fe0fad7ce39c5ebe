// Where lines run: between pixels. Each pixel says of its right and its upper side whether a line runs along it.

float encodeSides(bool right, bool above) { return (float(right) + 2.0 * float(above)) / 255.0; }

// x: right, y: above.
bvec2 decodeSides(float code) {
    int sides = int(code * 255.0 + 0.5);
    return bvec2((sides & 1) != 0, (sides & 2) != 0);
}

// Farther than any line reaches.
const float NO_LINE = 1e9;
