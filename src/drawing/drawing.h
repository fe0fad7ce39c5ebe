// A drawing: lines as vectors, to be written over an image of all else.
#pragma once

#include "drawing/ink.h"
#include "image/image.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

/// One layer of lines, as a technique finds and draws them.
struct LineLayer {
    MeshLineRequest request;
    InkLook look;
};

struct Drawing : VectorContent {
    struct Layer {
        std::vector<DrawnLine> lines;
        InkLook look;
    };
    struct Object {
        std::string name;
        std::vector<std::string> parts;
    };
    glm::ivec2 size{0};  ///< of the picture in pixels: what lines count in
    double dpi = 96;     ///< pixels per inch: the drawing's size on paper
    std::vector<Layer> layers;
    std::vector<LineRecord> records;     ///< DrawnLine::record
    std::vector<std::string> materials;  ///< DrawnLine::material
    std::vector<Object> objects;         ///< DrawnLine::instance

    double millimetres(double pixels) const { return pixels * 25.4 / dpi; }
};

/// A line on paper: millimetres from the upper left.
struct PaperLine {
    std::vector<std::vector<glm::dvec2>> paths;  ///< its dashes; closed where it has one and isClosed
    bool isClosed = false;
    double width = 0;    ///< millimetres
    double opacity = 1;  ///< 0 … 1
    Color color;
    const DrawnLine* line = nullptr;
};

/// Lines of one source, all visible or all hidden.
struct PaperGroup {
    bool isHidden = false;
    MeshLineSource source = MeshLineSource::contours;
    InkStyle style;  ///< of those whose record says nothing else; its width is millimetres here
    double opacity = 1;
    std::vector<PaperLine> lines;
};

/// A drawing's lines from the lowest to the topmost: hidden ones first, then the narrower ones. Points that lie within
/// `simplify` millimetres of the line without them are left out (Douglas & Peucker 1973).
std::vector<PaperGroup> onPaper(const Drawing& drawing, double simplify);

/// "door / leaf": the object and part that a line belongs to; the object alone where it has one part.
std::string objectOf(const Drawing& drawing, const DrawnLine& line);

}  // namespace limn
