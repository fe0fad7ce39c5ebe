#include "rays/embree.h"

#include "base/error.h"

#include <fmt/format.h>

namespace limn {

EmbreeDevice makeEmbreeDevice() {
    EmbreeDevice device(rtcNewDevice(nullptr));
    if (!device) checkEmbree(nullptr, {});
    return device;
}

void checkEmbree(RTCDevice device, const TreePurpose& purpose) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw Error(ExitCode::outOfMemory, {}, fmt::format("there is not enough memory for {}", purpose.name),
            std::string(purpose.remedy));
    throw Error(ExitCode::internal, {}, fmt::format("Embree failed with code {}", static_cast<int>(error)),
        "please report this");
}

EmbreeScene treeOfBoxes(RTCDevice device, std::size_t count, void* user, RTCBoundsFunction bounds,
    RTCOccludedFunctionN meet, const TreePurpose& purpose) {
    EmbreeScene boxes(rtcNewScene(device));
    rtcSetSceneFlags(boxes.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(boxes.get(), RTC_BUILD_QUALITY_LOW);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    if (meet) rtcSetGeometryOccludedFunction(geometry, meet);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(boxes.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(boxes.get());
    checkEmbree(device, purpose);
    return boxes;
}

}  // namespace limn
