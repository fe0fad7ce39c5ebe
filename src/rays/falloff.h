// The falloff of an occluder's weight with distance: part of the definition of ambient occlusion, shared by all
// techniques.
#pragma once

#include "settings/fields.h"

namespace limn {

/// w(d/R) for 0 ≤ d ≤ R: 1, 1 − d/R, 1 − (d/R)². Beyond R always 0. Mirrored by shaders/lib/occlusion.glsl.
enum class Falloff { none, linear, quadratic };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<Falloff> = {"none", "linear", "quadratic"};

}  // namespace limn
