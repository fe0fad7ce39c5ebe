// Marks the tiles of the picture near lines: drawing lines has nothing to do elsewhere.
#include "lib/space.glsl"

void main() {
    ivec2 tile = thisPixel();
    ivec2 last = (view.size - 1) / MASK_TILE;
    if (any(greaterThan(tile, last))) return;
    float found = 0.0;
    for (int y = -params.reach; y <= params.reach; ++y)
        for (int x = -params.reach; x <= params.reach; ++x)
            found = max(found, load(tiles, clamp(tile + ivec2(x, y), ivec2(0), last)).r);
    write_result(vec4(found));
}
