// Randomness as a pure function of (global pixel, sample, seed): the same for every tile, thread and driver.
//
// Include after lib/space.glsl. Integer arithmetic only, so that every implementation agrees to the bit.

// A 32-bit mix in which every input bit flips every output bit about half the time.
uint mixBits(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// [0, 1) with 24 bits.
float unitFloat(uint x) { return float(x >> 8) * (1.0 / 16777216.0); }

// Pixel of the whole picture (xy) and number of the sample within it (z).
ivec3 sampleOf(ivec2 pixel) { return ivec3(pixel + view.origin / COARSENESS, view.sampleNumber); }

// Two numbers in [0, 1) that are evenly spread over neighbouring pixels and over the samples of a pixel: additive
// recurrences with the generalized golden ratios of two and three dimensions (multiples of 2^32), shifted by the seed.
vec2 evenlySpread(ivec2 pixel) {
    uvec3 s = uvec3(sampleOf(pixel));
    uint first = s.x * 3242174889u + s.y * 2447445414u + s.z * 2654435769u;
    uint second = s.x * 3518319155u + s.y * 2882110345u + s.z * 2360945575u;
    return vec2(unitFloat(first + mixBits(view.seed * 2u)), unitFloat(second + mixBits(view.seed * 2u + 1u)));
}

// A unit vector, uniform over the sphere, from two uniform numbers (Archimedes: heights on a sphere are uniform).
vec3 onSphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = sqrt(max(0.0, 1.0 - z * z));
    float angle = 6.283185307 * u.y;
    return vec3(r * cos(angle), r * sin(angle), z);
}
