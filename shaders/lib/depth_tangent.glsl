// The bend of the depth image at a pixel, as a measure of edges and hollows.

// A difference as a share of the range → 1/(1 + s²). It is 1 at no difference, least at a difference of `1/perBleach`,
// and 1 again from twice that on (or the value of `brightness` alone). Without CUT it stays least beyond `1/perBleach`.
float openAt(float p, float perBleach, float brightness) {
#ifndef CUT
    p = min(p, 1.0 / perBleach);
#endif
    float s = 0.5 * max(p * (2.0 - p * perBleach) + brightness, 0.0);
    return 1.0 / (1.0 + s * s);
}

// The depth midway between two opposite pixels, if both lay on one plane: the harmonic mean in perspective.
float betweenOpposite(float a, float b) {
    if (ORTHOGRAPHIC) return 0.5 * a + 0.5 * b;
    return 2.0 / (1.0 / a + 1.0 / b);
}
