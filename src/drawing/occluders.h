// What hides a line: the faces before it, and where along it.
//
// Appel's quantitative invisibility (1967), found exactly: each triangle hides the part of a line that it covers in the
// picture and lies before. Where two triangles meet, both find the same end to the bit, so nothing leaks between them.
// No ray can graze: triangles on the line's own edge are left out by their vertices, and a triangle that shares one
// vertex with the line lies neither before nor behind it there.
#pragma once

#include "drawing/candidates.h"

#include <memory>
#include <vector>

namespace limn {

/// A part of a line, from one parameter to another (0: its first end in space, 1: its second).
struct LinePart {
    double from = 0, to = 1;
    int behind = 0;  ///< number of faces before it
};

class Occluders {
public:
    /// Builds a tree over the triangles' boxes in the picture. Keeps references. Throws Error (out of memory).
    Occluders(const ViewedScene& scene, glm::ivec2 imageSize, double margin);
    ~Occluders();
    Occluders(const Occluders&) = delete;
    Occluders& operator=(const Occluders&) = delete;

    /// The parts of a line that lie in the picture or its margin, in their order, without gaps between neighbours. Of a
    /// border the parts where another surface goes on without a step are left out. Numbers of faces beyond `deepest`
    /// are one more than it. May be called from many threads.
    std::vector<LinePart> partsOf(const Candidate& line, int deepest) const;

    struct Tree;

private:
    std::unique_ptr<Tree> tree_;
};

}  // namespace limn
