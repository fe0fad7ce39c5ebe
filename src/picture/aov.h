// The vocabulary of images: passes and people use these names for them. Slots promise AOVs (effects/slot.h); readers
// never name a technique. This file declares the AOVs of several effects. A technique's own file declares, in the same
// way, an AOV that it alone makes.
#pragma once

#include "picture/format.h"

#include <array>
#include <string_view>
#include <vector>

namespace limn {

/// What the numbers of an image are.
enum class AovKind {
    colour,     ///< linear Rec.709; display-encoded in 8 and 16 bit files
    numbers,    ///< as they are
    direction,  ///< unit vectors, kept as two octahedral coordinates (shaders/lib/normals.glsl)
    depth,      ///< normalized units in memory, scene units in files; kBackgroundDepth where nothing is
};

enum class AovUse {
    mean,           ///< a picture has the mean over a pixel's samples
    centre,         ///< a picture has the value at the pixel's centre
    betweenPasses,  ///< nobody can ask for it
};

struct Aov {
    std::string_view name;
    Format format;
    std::array<std::string_view, 4> channels;  ///< as EXR names them; empty ones do not exist
    AovKind kind;
    AovUse use;
    std::string_view doc;
    std::string_view onlyBy;  ///< the only technique that makes it; empty: all techniques of the slots that promise it

    /// Registers the AOV, unless it is for use between passes.
    Aov(std::string_view name_, Format format_, std::array<std::string_view, 4> channels_, AovKind kind_, AovUse use_,
        std::string_view doc_, std::string_view onlyBy_ = {});
    Aov(const Aov&) = delete;
    Aov& operator=(const Aov&) = delete;

    int channelCount() const;
    bool isColour() const { return kind == AovKind::colour; }
    bool isAveraged() const { return use == AovUse::mean; }
    bool isInteger() const { return info(format).glslPrefix == "u"; }
};

namespace aov {

inline const Aov beauty{"beauty", Format::rgba32f, {"R", "G", "B", "A"}, AovKind::colour, AovUse::mean,
    "The picture. Linear Rec.709, premultiplied alpha."};
inline const Aov shade{"shade", Format::rgba16f, {"R", "G", "B", "A"}, AovKind::colour, AovUse::mean,
    "Shaded objects before lines and background. Linear Rec.709, premultiplied alpha."};
inline const Aov albedo{"albedo", Format::rgba16f, {"R", "G", "B", "A"}, AovKind::colour, AovUse::mean,
    "The objects' own colours, textures included. Linear Rec.709, premultiplied alpha."};
inline const Aov ambientOcclusion{"ambient_occlusion", Format::r32f, {"Y"}, AovKind::numbers, AovUse::mean,
    "Filtered ambient visibility: 1 open, 0 closed, background 1."};
inline const Aov ambientOcclusionRaw{"ambient_occlusion_raw", Format::r32f, {"Y"}, AovKind::numbers, AovUse::mean,
    "Ambient visibility before its filter, noise and all."};
inline const Aov depthTangent{"depth_tangent", Format::r32f, {"Y"}, AovKind::numbers, AovUse::mean,
    "Ambient shading and lines in one, from depth alone: what the picture is multiplied by.", "depth_tangent"};
inline const Aov edges{"edges", Format::rgba16f, {"R", "G", "B", "A"}, AovKind::colour, AovUse::mean,
    "The lines alone. Linear Rec.709, premultiplied alpha."};
inline const Aov normal{"normal", Format::rg32f, {"X", "Y", "Z"}, AovKind::direction, AovUse::centre,
    "Shading normal in view space (x right, y up, z towards the viewer); zero on the background."};
inline const Aov normalGeometric{"normal_geometric", Format::rg32f, {"X", "Y", "Z"}, AovKind::direction, AovUse::centre,
    "Normal of the triangle in view space, towards the viewer; zero on the background."};
inline const Aov depth{"depth", Format::r32f, {"Z"}, AovKind::depth, AovUse::centre,
    "Distance along the view axis in scene units; infinite on the background."};
inline const Aov position{"position", Format::rgba32f, {"X", "Y", "Z"}, AovKind::numbers, AovUse::centre,
    "Position in the scene's space and units; zero on the background."};
inline const Aov objectId{"object_id", Format::r32ui, {"id"}, AovKind::numbers, AovUse::centre,
    "Number of the object (instances in scene order, their parts in file order), from 1; 0 on the background."};
inline const Aov materialId{"material_id", Format::r32ui, {"id"}, AovKind::numbers, AovUse::centre,
    "Number of the material, from 1; 0 on the background."};

inline const Aov motion{"motion", Format::rg32f, {"X", "Y"}, AovKind::numbers, AovUse::centre,
    "How far the visible point has come in the picture since the frame before, in pixels to the right and up, by the "
    "motion of its object and the camera (what a mesh with a file per frame does within itself is not in it); zero on "
    "the "
    "background.",
    "exact"};

inline const Aov lineRecord{"line_record", Format::r32ui, {"id"}, AovKind::numbers, AovUse::betweenPasses,
    "Number of what the object or its material says about its lines; 0 for nothing."};
inline const Aov surfacePlace{"surface_place", Format::r32ui, {"place"}, AovKind::numbers, AovUse::betweenPasses,
    "Where the visible point lies in its mesh, as a number: near points have near ones. Only of the exact geometry."};
inline const Aov visibility{"visibility", Format::rg32ui, {"instance", "triangle"}, AovKind::numbers,
    AovUse::betweenPasses,
    "Instance, counted from 1, and triangle (one number where both fit, see shaders/lib/seen.glsl); on the fine "
    "raster. Only of the exact geometry; R32UI where one number is enough."};

}  // namespace aov

/// Every AOV that can be asked for, by name.
const std::vector<const Aov*>& allAovs();
const Aov* findAov(std::string_view name);

/// The background's value in the image `depth`. Files say infinity.
inline constexpr float kBackgroundDepth = 3.402823466e38f;

}  // namespace limn
