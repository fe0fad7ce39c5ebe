// Embree's handles as values, and its errors as ours.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <memory>
#include <string_view>

namespace limn {

struct ReleaseEmbree {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, ReleaseEmbree>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, ReleaseEmbree>;

/// What a tree is for, as messages have it: "the ray tracing tree"; and how to do without.
struct TreePurpose {
    std::string_view name, remedy;
};

/// Throws Error (internal) where Embree cannot begin.
EmbreeDevice makeEmbreeDevice();

/// Embree reports error codes. The only failure that input can cause is a lack of memory. Throws Error.
void checkEmbree(RTCDevice device, const TreePurpose& purpose);

/// A tree over boxes that `bounds` tells of `user`. It is made fast rather than walked fast. `meet`, unless null, is
/// told the boxes on a ray of rtcOccluded1. Throws Error.
EmbreeScene treeOfBoxes(RTCDevice device, std::size_t count, void* user, RTCBoundsFunction bounds,
    RTCOccludedFunctionN meet, const TreePurpose& purpose);

}  // namespace limn
