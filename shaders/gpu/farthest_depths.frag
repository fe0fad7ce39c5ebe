// The farthest depth of each square of SIDE × SIDE pixels of a depth buffer: anything behind it is invisible there.
// Depth is reversed: the least value is the farthest.
layout(binding = 0) uniform sampler2D depth;
layout(location = 0) out float farthest;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * SIDE, last = textureSize(depth, 0) - 1;
    float least = 1.0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) least = min(least, texelFetch(depth, min(first + ivec2(x, y), last), 0).r);
    farthest = least;
}
