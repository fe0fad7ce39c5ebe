// Which tiles of the picture lie near lines: elsewhere there is nothing to do for those who draw them.
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
