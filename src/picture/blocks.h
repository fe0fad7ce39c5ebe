// Large pictures are made of blocks and tiles.
//
// Blocks are part of what a picture is: each is drawn with triangles of its own, below every driver's limit and small
// enough for memory. Tiles are how a block is worked through: tiles of any size give the same bits.
#pragma once

#include "picture/pixel_rect.h"

#include <utility>
#include <vector>

namespace limn {

/// A part of a picture, in pixels from the lower left: the block that its triangles are drawn with, and itself.
struct Tile {
    PixelRect block, rect;
};

/// The longest side that a block of a picture of this size has.
int largestBlockSide(glm::ivec2 size);
/// The first block, which is as large as any.
glm::ivec2 largestBlock(glm::ivec2 size);

/// Cuts [0, length) into spans of at most `most`, begun at multiples of four: what is drawn at half the size keeps its
/// place.
std::vector<std::pair<int, int>> spans(int length, int most);

/// Along one axis: where a tile's block begins and ends, and where the tile does.
struct TileSpan {
    int blockFrom, blockTo, from, to;
};
/// The tiles of at most `most` pixels that cover `wanted` (origin and length along the axis), in order.
std::vector<TileSpan> tileSpans(glm::ivec2 pictureSize, int axis, int most, const PixelRect& wanted);

}  // namespace limn
