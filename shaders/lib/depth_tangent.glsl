// How the depth image bends at a pixel, and what that says about edges and hollows.

// A difference as a share of the range → 1/(1 + s²): 1 where nothing differs, least where the difference is
// `1/perBleach`, 1 again at twice that and beyond (or what `brightness` alone gives); without CUT as little beyond as
// there.
float openAt(float p, float perBleach, float brightness) {
#ifndef CUT
    p = min(p, 1.0 / perBleach);
#endif
    float s = 0.5 * max(p * (2.0 - p * perBleach) + brightness, 0.0);
    return 1.0 / (1.0 + s * s);
}

// Depth at the middle between two opposite pixels if both lay on one plane: the harmonic mean in perspective.
float betweenOpposite(float a, float b) {
    if (ORTHOGRAPHIC) return 0.5 * a + 0.5 * b;
    return 2.0 / (1.0 / a + 1.0 / b);
}
