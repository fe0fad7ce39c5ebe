// How lines look.
#pragma once

#include "lines/sources.h"
#include "settings/fields.h"

namespace limn {

/// The side of a surface's border on which its line lies.
enum class LineSide { both, inner, outer };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<LineSide> = {"both", "inner", "outer"};

/// How lines of one source look.
struct LineStyle {
    double width = 0;  ///< pixels of the output; 0: there are none
    Color color;
    bool operator==(const LineStyle&) const = default;
};

/// Everything about how lines look.
struct Stroke {
    PerSource<LineStyle> styles{};
    float opacity = 1;
    LineSide side = LineSide::both;
    double fade = 0, taper = 0;       ///< shares of opacity and width lost with depth
    double fadeFrom = 0, fadeTo = 1;  ///< normalized units: where they begin to, and have

    double widest() const;
};

}  // namespace limn
