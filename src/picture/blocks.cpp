#include "picture/blocks.h"

#include <algorithm>

namespace limn {

int largestBlockSide(glm::ivec2 size) { return std::max(size.x, size.y) <= 4096 ? 4096 : 2048; }

std::vector<std::pair<int, int>> spans(int length, int most) {
    const int count = (length + most - 1) / most;
    const int step = std::min((((length + count - 1) / count) + 3) / 4 * 4, std::max(most, 4));
    std::vector<std::pair<int, int>> result;
    for (int at = 0; at < length; at += step) result.emplace_back(at, std::min(at + step, length));
    return result;
}

glm::ivec2 largestBlock(glm::ivec2 size) {
    const auto first = [&](int length) { return spans(length, largestBlockSide(size)).front().second; };
    return {first(size.x), first(size.y)};
}

std::vector<TileSpan> tileSpans(glm::ivec2 pictureSize, int axis, int most, const PixelRect& wanted) {
    const int length = pictureSize[axis], first = wanted.origin[axis] / 4 * 4;
    const int last = std::min(length, (wanted.origin[axis] + wanted.size[axis] + 3) / 4 * 4);
    std::vector<TileSpan> tiles;
    for (const auto& [blockFrom, blockTo] : spans(length, largestBlockSide(pictureSize)))
        for (const auto& [from, to] : spans(blockTo - blockFrom, most)) {
            const TileSpan tile{blockFrom, blockTo, std::max(blockFrom + from, first), std::min(blockFrom + to, last)};
            if (tile.from < tile.to) tiles.push_back(tile);
        }
    return tiles;
}

}  // namespace limn
