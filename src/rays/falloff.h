// How the weight of an occluder falls with its distance: part of what ambient occlusion means here, shared by every
// technique.
#pragma once

#include "settings/fields.h"

namespace limn {

/// w(d/R) for 0 ≤ d ≤ R: 1, 1 − d/R, 1 − (d/R)². Beyond R always 0. Mirrored by shaders/lib/occlusion.glsl.
enum class Falloff { none, linear, quadratic };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<Falloff> = {"none", "linear", "quadratic"};

}  // namespace limn
