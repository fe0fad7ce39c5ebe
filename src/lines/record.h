// What objects and materials say about their own lines, as shaders look it up by number.
#pragma once

#include "settings/values.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace limn {

/// What an object and its material say about its lines; what they leave out is as the line technique says.
struct LineRecord {
    bool draws = true;
    OptionalColor color;
    double creaseAngle = 0;  ///< degrees; 0 = not said
    bool isCut = false;      ///< the cut face of a section
    bool operator==(const LineRecord&) const = default;
};

/// A crossing of lines has eight bits for the number of a record (shaders/lib/lines.glsl).
inline constexpr std::size_t kMostLineRecords = 256;

/// Colour, cosine of the crease angle (-2: not said), flags: what lineRecordAt() of shaders/scene/scene.glsl reads.
std::array<std::uint32_t, 5> lineRecordWords(const LineRecord& record);

}  // namespace limn
