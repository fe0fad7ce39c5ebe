// How lines from the mesh are inked: widths, colours, dashes; and the picture of it.
#pragma once

#include "drawing/drawn_line.h"
#include "graph/graph.h"
#include "lines/record.h"

#include <span>
#include <vector>

namespace limn {

/// Dashes of a line. Each straight run of a line begins and ends with a dash, so that corners are drawn: dashes and
/// gaps become a little longer or shorter for it.
struct Dashes {
    double dash = 0, gap = 0;  ///< pixels; dash 0: the line is whole
    bool operator==(const Dashes&) const = default;
};

/// How lines of one source look, visible or hidden.
struct InkStyle {
    double width = 0;  ///< pixels; 0: there are none
    Color color;
    Dashes dashes;
};

struct InkLook {
    PerMeshSource<InkStyle> visible{}, hidden{};
    float opacity = 1;
    double fade = 0, taper = 0;       ///< shares of opacity and width lost with depth
    double fadeFrom = 0, fadeTo = 1;  ///< normalized units: where they begin to, and have

    double widest() const;
    const InkStyle& of(const DrawnLine& line) const {
        return (line.behind > 0 ? hidden : visible)[static_cast<std::size_t>(line.source)];
    }
};

/// The dashes of a line, each a polyline of its own; the line itself where it is whole.
std::vector<std::vector<LinePoint>> dashesOf(const DrawnLine& line, const Dashes& dashes);

/// The colour of a line: its record's, or its style's.
Color colorOf(const DrawnLine& line, const InkStyle& style, std::span<const LineRecord> records);

/// Draws lines into the part of an image (linear colour, premultiplied) over what `below` has there, or over nothing.
/// `origin`: of the image in the whole picture. Each pixel is inked by the area of the line's band in it, so that one
/// sample is enough; wider lines lie on narrower ones. Every part of a picture comes out the same to the bit.
void drawInk(std::span<const DrawnLine> lines, const InkLook& look, std::span<const LineRecord> records,
    glm::ivec2 origin, const PixelRect& part, const HostImage* below, HostImage& image);

}  // namespace limn
