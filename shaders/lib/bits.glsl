// Bits mixed and interleaved: integer arithmetic, to the same bit everywhere.

// A 32-bit mix in which every input bit flips every output bit about half the time.
uint mixBits(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// Bits of x at the even places, bits of y at the odd ones: squares of 2^n pixels share all but the last 2n bits.
uint interleaved(uvec2 p) {
    uvec2 v = p & 0xffffu;
    v = (v | (v << 8)) & 0x00ff00ffu;
    v = (v | (v << 4)) & 0x0f0f0f0fu;
    v = (v | (v << 2)) & 0x33333333u;
    v = (v | (v << 1)) & 0x55555555u;
    return v.x | (v.y << 1);
}

// The same of three numbers of ten bits each: cubes of 2^n cells share all but the last 3n bits.
uint interleaved(uvec3 p) {
    uvec3 v = p & 0x3ffu;
    v = (v | (v << 16)) & 0x030000ffu;
    v = (v | (v << 8)) & 0x0300f00fu;
    v = (v | (v << 4)) & 0x030c30c3u;
    v = (v | (v << 2)) & 0x09249249u;
    return v.x | (v.y << 1) | (v.z << 2);
}
