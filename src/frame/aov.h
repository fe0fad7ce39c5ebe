// The vocabulary of images: the names by which passes and people speak of them. Techniques promise AOVs; readers never
// name a technique.
#pragma once

#include "graph/format.h"

#include <array>
#include <optional>
#include <string_view>

namespace limn {

struct Aov {
    std::string_view name;
    Format format;
    std::array<std::string_view, 4> channels;  ///< as EXR names them; empty ones do not exist
    bool isColour;                             ///< display-encoded in 8 and 16 bit files
    bool isAveraged;  ///< the mean over the pixel's samples; else the value at the pixel's centre
    std::string_view doc;
    bool isDirection = false;  ///< unit vectors, kept as two octahedral coordinates (shaders/lib/normals.glsl)

    int channelCount() const {
        int count = 0;
        while (count < 4 && !channels[static_cast<std::size_t>(count)].empty()) ++count;
        return count;
    }
    bool isInteger() const { return info(format).glslPrefix == "u"; }
};

namespace aov {

inline constexpr Aov beauty{
    "beauty", Format::rgba32f, {"R", "G", "B", "A"}, true, true, "The picture. Linear Rec.709, premultiplied alpha."};
inline constexpr Aov shade{"shade", Format::rgba16f, {"R", "G", "B", "A"}, true, true,
    "Shaded objects before lines and background. Linear Rec.709, premultiplied alpha."};
inline constexpr Aov albedo{"albedo", Format::rgba16f, {"R", "G", "B", "A"}, true, true,
    "The objects' own colours, textures included. Linear Rec.709, premultiplied alpha."};
inline constexpr Aov ambientOcclusion{"ambient_occlusion", Format::r32f, {"Y"}, false, true,
    "Filtered ambient visibility: 1 open, 0 closed, background 1."};
inline constexpr Aov ambientOcclusionRaw{
    "ambient_occlusion_raw", Format::r32f, {"Y"}, false, true, "Ambient visibility before its filter, noise and all."};
inline constexpr Aov ambientOcclusionError{"ambient_occlusion_error", Format::r32f, {"Y"}, false, true,
    "Standard error of one sample's ambient_occlusion_raw, as the ray tracer estimates it."};
inline constexpr Aov depthTangent{"depth_tangent", Format::r32f, {"Y"}, false, true,
    "Ambient shading and lines in one, from depth alone: what the picture is multiplied by."};
inline constexpr Aov edges{"edges", Format::rgba16f, {"R", "G", "B", "A"}, true, true,
    "The lines alone. Linear Rec.709, premultiplied alpha."};
inline constexpr Aov normal{"normal", Format::rg32f, {"X", "Y", "Z"}, false, false,
    "Shading normal in view space (x right, y up, z towards the viewer); zero on the background.", true};
inline constexpr Aov normalGeometric{"normal_geometric", Format::rg32f, {"X", "Y", "Z"}, false, false,
    "Normal of the triangle in view space, towards the viewer; zero on the background.", true};
inline constexpr Aov depth{"depth", Format::r32f, {"Z"}, false, false,
    "Distance along the view axis in scene units; infinite on the background."};
inline constexpr Aov position{"position", Format::rgba32f, {"X", "Y", "Z"}, false, false,
    "Position in the scene's space and units; zero on the background."};
inline constexpr Aov objectId{"object_id", Format::r32ui, {"id"}, false, false,
    "Number of the object (instances in scene order, their parts in file order), from 1; 0 on the background."};
inline constexpr Aov materialId{
    "material_id", Format::r32ui, {"id"}, false, false, "Number of the material, from 1; 0 on the background."};

// Between passes only: nobody can ask for these.
inline constexpr Aov lineRecord{"line_record", Format::r32ui, {"id"}, false, false,
    "Number of what the object or its material says about its lines; 0 for nothing."};
inline constexpr Aov visibility{"visibility", Format::rg32ui, {"instance", "triangle"}, false, false,
    "Instance, counted from 1, and triangle (one number where both fit, see shaders/lib/seen.glsl); on the fine "
    "raster. Only of the exact geometry."};

inline constexpr const Aov* all[] = {&beauty, &shade, &albedo, &ambientOcclusion, &ambientOcclusionRaw,
    &ambientOcclusionError, &depthTangent, &edges, &normal, &normalGeometric, &depth, &position, &objectId,
    &materialId};

}  // namespace aov

inline const Aov* findAov(std::string_view name) {
    for (const Aov* aov : aov::all)
        if (aov->name == name) return aov;
    return nullptr;
}

/// What the images `depth` holds where nothing was hit. Files say infinity.
inline constexpr float kBackgroundDepth = 3.402823466e38f;

}  // namespace limn
