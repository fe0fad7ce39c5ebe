// Marks the tiles of the picture that have a line.
#include "lib/space.glsl"

void main() {
    ivec2 tile = thisPixel();
    if (any(greaterThanEqual(tile * MASK_TILE, view.size))) return;
    uint found = 0u;
    for (int y = 0; y < MASK_TILE; ++y)
        for (int x = 0; x < MASK_TILE; ++x) {
            ivec2 pixel = min(tile * MASK_TILE + ivec2(x, y), view.size - 1);
            found |= load(sides, pixel).r;
#ifdef WITH_MARKS
            found |= uint(load(marks, pixel).z) | uint(load(marksBeside, pixel).z);
#endif
        }
    write_result(vec4(found != 0u ? 1.0 : 0.0));
}
