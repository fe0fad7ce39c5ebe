// Line records: the overrides of objects and materials for their own lines, which shaders look up by number.
#pragma once

#include "settings/values.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace limn {

/// The settings of an object and its material for its lines. The line technique decides what they leave out.
struct LineRecord {
    bool draws = true;
    OptionalColor color;
    double creaseAngle = 0;  ///< degrees; 0 = not said
    bool isCut = false;      ///< the cut face of a section
    bool operator==(const LineRecord&) const = default;
};

/// A crossing of a line has eight bits for a record's number (shaders/lib/lines.glsl).
inline constexpr std::size_t kMostLineRecords = 256;

/// Colour, cosine of the crease angle (-2: not said), flags: what lineRecordAt() of shaders/scene/scene.glsl reads.
std::array<std::uint32_t, 5> lineRecordWords(const LineRecord& record);

}  // namespace limn
