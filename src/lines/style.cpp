#include "lines/style.h"

#include <algorithm>

namespace limn {

double Stroke::widest() const {
    double width = 0;
    for (const auto& style : styles) width = std::max(width, style.width);
    return width;
}

}  // namespace limn
