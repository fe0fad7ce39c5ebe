// Pieces of lines become polylines.
#pragma once

#include "drawing/candidates.h"

namespace limn {

/// Where a piece ends alone.
inline constexpr std::uint64_t kNoNode = 0;

/// A straight piece in the picture, behind the same number of faces all along.
struct LinePiece {
    std::array<LinePoint, 2> end;
    std::array<std::uint64_t, 2> node{kNoNode, kNoNode};  ///< pieces are neighbours where they share one
    std::uint32_t candidate = 0;                          ///< index
    int behind = 0;
};

/// Shorter gaps are closed, and shorter visible parts between hidden ones left out, in pixels: nobody sees them, and a
/// mesh's small folds beside its contour make many.
inline constexpr double kShortestPart = 0.25;

/// Of the contours of curved surfaces, which facets break up, in pixels: visible parts between hidden ones, and hooks
/// at cusps, that are shorter are left out; folds that leave a smaller gap are bridged.
inline constexpr double kShortestCurve = 0.5, kLongestFold = 1;

/// And pieces shorter than the first are left out where they run within the second of a longer line.
inline constexpr double kLongestEcho = 4, kBeside = 0.2;

/// Removes the parts of pieces that lie on others in the picture, so that no line is drawn twice: hidden ones under
/// visible ones, then those of the later source, then those that come later. Pieces behind more
/// than `deepest` faces are left as they are.
void removeOverlaps(std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest);

/// Joins pieces of one source, object, material and record; at junctions those that go on straightest. A closed line
/// begins anywhere. In the order of the pieces.
std::vector<DrawnLine> chain(const std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest);

}  // namespace limn
