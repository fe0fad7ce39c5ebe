// Randomness as a pure function of (global pixel, sample, seed): the same for every tile, thread and driver.
//
// Include after lib/space.glsl. Integer arithmetic only, so that every implementation agrees to the bit.

#include "lib/bits.glsl"

// [0, 1) with 24 bits.
float unitFloat(uint x) { return float(x >> 8) * (1.0 / 16777216.0); }

// Pixel of the whole picture (xy) and number of the sample within it (z).
ivec3 sampleOf(ivec2 pixel) { return ivec3(pixel + view.origin / COARSENESS, view.sampleNumber); }

// Two numbers in [0, 1) that are evenly spread over neighbouring pixels and over the samples of a pixel, without a
// pattern that a filter could leave behind.
//
// Pixels take the points of a (0, 2)-sequence (Sobol's) in the order of a curve through ever larger squares, each
// turned at random: the error of neighbours differs as much as it can, and its spectrum has no peaks (Ahmed & Wonka,
// "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels", 2020). The
// samples of a pixel shift its point by additive recurrences of the golden ratio and of its like in two dimensions.
//
// NOISE_ON_SURFACE: cells of the visible mesh take the place of pixels, so that noise moves along with what it lies on.
vec2 evenlySpread(ivec2 pixel) {
    uvec3 s = uvec3(sampleOf(pixel));
    // The order at random: each bit of the place flips by a hash of the bits above it. (Laine & Karras 2011, with the
    // constants of Vegdahl; the first bit of the reversed place is its last.)
#ifdef NOISE_ON_SURFACE
    uint place = bitfieldReverse(load(surfacePlace, pixel * COARSENESS).r);
#else
    uint place = bitfieldReverse(interleaved(s.xy));
#endif
    place ^= place * 0x3d20adeau;
    place += mixBits(view.seed);
    place *= (mixBits(view.seed) >> 16) | 1u;
    place ^= place * 0x05526c56u;
    place ^= place * 0x53a22864u;
    // Reversed bits of the number in the sequence are the first coordinate; the second mixes them by Pascal's triangle.
    uint second = place;
    second ^= (second << 1) & 0xaaaaaaaau;
    second ^= (second << 2) & 0xccccccccu;
    second ^= (second << 4) & 0xf0f0f0f0u;
    second ^= (second << 8) & 0xff00ff00u;
    second ^= second << 16;
    return vec2(unitFloat(place + s.z * 2654435769u), unitFloat(second + s.z * 2360945575u));
}

// A unit vector, uniform over the sphere, from two uniform numbers (Archimedes: heights on a sphere are uniform).
vec3 onSphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = sqrt(max(0.0, 1.0 - z * z));
    float angle = 6.283185307 * u.y;
    return vec3(r * cos(angle), r * sin(angle), z);
}
