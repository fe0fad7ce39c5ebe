// Large pictures are made of blocks and tiles.
//
// Blocks are part of the picture: each draws its own triangles, below every driver's limit and small enough for memory.
// Tiles are the steps in which a block is drawn: tiles of any size give the same bits.
#pragma once

#include "picture/pixel_rect.h"

#include <utility>
#include <vector>

namespace limn {

/// A part of a picture and the block whose triangles it draws, in pixels from the lower left.
struct Tile {
    PixelRect block, rect;
};

/// The longest side of a block in a picture of this size.
int largestBlockSide(glm::ivec2 size);
/// The first block, which is as large as any.
glm::ivec2 largestBlock(glm::ivec2 size);

/// Cuts [0, length) into spans of at most `most`, begun at multiples of four: images of half the size keep their place.
std::vector<std::pair<int, int>> spans(int length, int most);

/// The ends of a tile and of its block along one axis.
struct TileSpan {
    int blockFrom, blockTo, from, to;
};
/// The tiles of at most `most` pixels that cover `wanted` (origin and length along the axis), in order.
std::vector<TileSpan> tileSpans(glm::ivec2 pictureSize, int axis, int most, const PixelRect& wanted);

}  // namespace limn
