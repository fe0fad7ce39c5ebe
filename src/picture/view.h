// One view of the scene: the camera's place, and the pixels and samples that are drawn.
//
// Fine pixels. A picture of n samples per pixel is drawn as m sub-frames, each on a raster k times finer, n = k²·m. A
// fine raster is k² ordinary sub-frames, interleaved: effects that count in output pixels step k fine pixels, so that
// their result does not depend on the split of n.
//
// Normalized units. All lengths on the GPU are scene units times a power of two. It brings the scene's diagonal to [1,
// 2), so that scenes of any size give the same bits.
#pragma once

#include "picture/pixel_rect.h"
#include "picture/sampling.h"
#include "scene/bounds.h"
#include "scene/scene.h"
#include "settings/uniform_block.h"

#include <functional>

namespace limn {

/// Facts about the scene that effects may need.
struct SceneInfo {
    Bounds bounds;  ///< of the drawn objects' vertices, at the first declared frame that shows any; scene units
    glm::dvec3 up{0, 1, 0};

    double diagonal() const { return bounds.diagonal(); }
    /// Normalized units per scene unit: a power of two.
    double unit() const;
};

struct View {
    glm::ivec2 imageSize{0};  ///< of the whole picture, in output pixels
    int guard = 0;  ///< width of the guard band in pixels: effects with a halo are then right at the picture's border
    PixelRect canvas;  ///< the triangles' target: the picture, or one block of a large one, and the guard band
    PixelRect region;  ///< the effects' target: the canvas, or a tile of it and a guard band
    Sampling sampling;
    int sample = 0;                      ///< of sampling.samples()
    int aoSamples = 1, lineSamples = 1;  ///< rates of finding ambient occlusion and lines; at most all samples
    unsigned seed = 0;
    bool isBlurred = false;       ///< every sample shows a moment of its own
    bool noiseOnSurface = false;  ///< randomness belongs to places on surfaces, not to pixels

    bool orthographic = false;
    glm::dvec3 eye{0};  ///< camera position, world, scene units
    /// World directions and offsets from the eye in scene units → view space in normalized units. Subtracting the eye
    /// first, in double, keeps scenes far from the origin exact: no matrix has a large translation.
    glm::dmat3 viewFromRelative{1};
    /// The sample's ray through pixel p, counted from the picture's lower left: its view-space xy at unit depth
    /// (orthographic: its xy) is (p + 0.5) · rayScale + rayOffset. Jitter and lens shift are included.
    glm::dvec2 rayScale{1}, rayOffset{0};
    glm::dvec2 samplePlace{0};  ///< place of the sample's rays within their pixels: from the centre, in pixels
    /// rayOffset of the sub-frame as a whole, without the sample's place on the fine raster.
    glm::dvec2 rasterOffset{0};
    double near = 0, far = 0;  ///< normalized units; only paper modes depend on `far`
    double clipFar = 1;        ///< normalized units: beyond everything; orthographic depth is linear up to here
    double unit = 1;           ///< normalized units per scene unit
    double diagonal = 1;       ///< scene units
    double dpi = 96;
    double nearest =
        0;  ///< depth of the nearest corner of the scene's box, or 0 where the eye is inside; normalized units
    int keptGuard = 0;    ///< pixels of the guard band that are wanted with the picture
    int widestGuard = 0;  ///< pixels: the widest guard band that effects may ask for

    /// Do things of this rate run in this sample?
    bool runs(int rate) const { return sampling.runs(rate, sample); }
    /// Clip space from view space for the canvas, as the fine raster sees it: reversed depth, infinitely far
    /// (perspective) or linear (orthographic).
    glm::dmat4 clipFromView() const;
    glm::dvec3 toView(const glm::dvec3& world) const { return viewFromRelative * (world - eye); }
    glm::dmat4 worldFromView() const;
    /// A length of a parameter in normalized units.
    double normalized(const Length& length) const { return length.inSceneUnits(diagonal) * unit; }
    double pixels(const PictureLength& length) const { return length.inPixels(imageSize.y, dpi); }
    /// The halo, in pixels, of an effect of this reach (normalized units) at the nearest possible surface: at most the
    /// widest guard band.
    int haloOf(double reach) const;
    /// Does a halo hold all that an effect would look at? Else the widest guard band has cut it.
    bool holds(int halo) const { return halo < widestGuard; }
};

struct ViewRequest {
    glm::ivec2 imageSize{1280, 720};
    PixelRect block, tile;                          ///< of the picture; empty: all of it
    int guard = 0, keptGuard = 0, widestGuard = 0;  ///< see View
    Sampling sampling;
    int sample = 0;
    int aoSamples = 0;    ///< 0: a half of them, but at least four
    int lineSamples = 0;  ///< 0: a quarter of them, but at least four
    unsigned seed = 0;
    bool isBlurred = false, noiseOnSurface = false;
    double dpi = 96;
};

View makeView(const Camera& camera, const SceneInfo& scene, const ViewRequest& request);

/// How far what is to be framed reaches in a direction from the middle of the scene's box: the largest dot product.
using Reach = std::function<double(const glm::dvec3& direction)>;
/// The camera of a scene that has none: a three-quarter view in which everything fills 85 % of the picture, in
/// whichever direction it first does.
Camera framingCamera(const SceneInfo& scene, glm::ivec2 imageSize, const Reach& reach);
/// The light of a scene that has none: a sun over the camera's left shoulder.
Light defaultSun(const Camera& camera, const SceneInfo& scene);

/// The uniform block `view` that every shader sees.
UniformBlock viewBlock(const View& view);

}  // namespace limn
