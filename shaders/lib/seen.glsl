// The content of the visibility buffer: the visible instance, counted from 1, and its visible triangle; 0 on the
// background.
//
// TRIANGLE_BITS: both fit into one number, and its lower bits are the triangle's.

#ifdef TRIANGLE_BITS
uint encodeSeen(uvec2 seen) { return (seen.x << TRIANGLE_BITS) | seen.y; }
uvec2 decodeSeen(uvec4 code) { return uvec2(code.x >> TRIANGLE_BITS, code.x & ((1u << TRIANGLE_BITS) - 1u)); }
#else
uvec2 encodeSeen(uvec2 seen) { return seen; }
uvec2 decodeSeen(uvec4 code) { return code.xy; }
#endif
