#include "picture/view.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// An orthonormal basis (columns: right, up, backward) of a camera.
glm::dmat3 cameraBasis(const Camera& camera, const glm::dvec3& sceneUp) {
    const glm::dvec3 backward = glm::normalize(camera.position - camera.lookAt);
    glm::dvec3 up = camera.up == glm::dvec3(0) ? sceneUp : camera.up;
    glm::dvec3 right = glm::cross(up, backward);
    if (glm::dot(right, right) < 1e-20 * glm::dot(up, up)) {
        // Looking straight along the up axis: any other axis will do, but always the same one.
        up = std::abs(backward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
        right = glm::cross(up, backward);
    }
    right = glm::normalize(right);
    return {right, glm::cross(backward, right), backward};
}

struct ViewConstants {
    glm::mat4 clipFromView, worldFromView;
    glm::dvec2 rayScaleExact, rayOffsetExact;
    glm::vec2 rayScale, rayOffset, samplePlace;
    glm::ivec2 canvasSize, placeInCanvas, origin, size;
    glm::ivec2 placeOnRaster;
    int raster, sample;
    unsigned seed;
    float unit, near, far, clipFar;
};

constexpr Field kViewConstants[] = {
    field<&ViewConstants::clipFromView>(
        "clipFromView", "Clip space of what triangles are drawn into at once; depth reversed, 0…1."),
    field<&ViewConstants::worldFromView>("worldFromView", "Directions only need its upper 3×3."),
    field<&ViewConstants::rayScaleExact>("rayScaleExact", "rayScale in double precision."),
    field<&ViewConstants::rayOffsetExact>("rayOffsetExact", "rayOffset in double precision."),
    field<&ViewConstants::rayScale>(
        "rayScale", "View-space xy at unit depth (orthographic: xy) = (pixel + 0.5) * rayScale + rayOffset."),
    field<&ViewConstants::rayOffset>("rayOffset", "See rayScale."),
    field<&ViewConstants::samplePlace>(
        "samplePlace", {.unit = "pixels"}, "Where the sample's rays go within their pixels, from the centre."),
    field<&ViewConstants::canvasSize>("canvasSize", {.unit = "pixels"}, "Of what clip space spans."),
    field<&ViewConstants::placeInCanvas>(
        "placeInCanvas", {.unit = "pixels"}, "Lower left of the region drawn, in that."),
    field<&ViewConstants::origin>("origin", {.unit = "pixels"},
        "Lower left of the region drawn, in the picture: negative where the guard band begins."),
    field<&ViewConstants::size>("size", {.unit = "pixels"}, "Of the region drawn: the size of every screen texture."),
    field<&ViewConstants::placeOnRaster>(
        "placeOnRaster", {.unit = "fine pixels"}, "Which fine pixel of each pixel this sample looks at."),
    field<&ViewConstants::raster>(
        "raster", "Fine pixels per pixel, each way, of what is drawn once for several samples."),
    field<&ViewConstants::sample>("sampleNumber", "Number of the sample within a pixel."),
    field<&ViewConstants::seed>("seed", "Of all randomness in this frame."),
    field<&ViewConstants::unit>("unit", "Normalized units per scene unit: a power of two."),
    field<&ViewConstants::near>("near", {.unit = "normalized units"}, "Nearest depth drawn."),
    field<&ViewConstants::far>("far", {.unit = "normalized units"}, "Depth that paper modes take for the far end."),
    field<&ViewConstants::clipFar>(
        "clipFar", {.unit = "normalized units"}, "Depth beyond everything, where orthographic depth ends."),
};

}  // namespace

double SceneInfo::unit() const {
    const double size = diagonal();
    return size > 0 && std::isfinite(size) ? std::ldexp(1.0, -std::ilogb(size)) : 1;
}

glm::dmat4 View::clipFromView() const {
    const glm::dvec2 size(canvas.size);
    // ndc = 2·(pixel − canvas.origin)/size − 1, and pixel (jitter is in the offset) = (xy − rasterOffset)/rayScale, at
    // the pixel's corner: + 0.5 − 0.5.
    const glm::dvec2 scale = 2.0 / (rayScale * size);
    const glm::dvec2 offset = 2.0 * (glm::dvec2(-canvas.origin) - rasterOffset / rayScale) / size - 1.0;
    glm::dmat4 m(0);
    m[0][0] = scale.x;
    m[1][1] = scale.y;
    if (orthographic) {
        m[3][0] = offset.x;
        m[3][1] = offset.y;
        // clipFar → 0, near → 1; depth is −z.
        m[2][2] = 1 / (clipFar - near);
        m[3][2] = clipFar / (clipFar - near);
        m[3][3] = 1;
    } else {
        m[2][0] = -offset.x;
        m[2][1] = -offset.y;
        m[2][3] = -1;
        m[3][2] = near;
    }
    return m;
}

int View::haloOf(double reach) const {
    const double footprint = rayScale.x * (orthographic ? 1 : nearest);
    return footprint > 0 && reach < footprint * widestGuard ? static_cast<int>(std::ceil(reach / footprint))
                                                            : widestGuard;
}

glm::dmat4 View::worldFromView() const {
    glm::dmat4 m(glm::transpose(viewFromRelative) / (unit * unit));
    m[3] = glm::dvec4(eye, 1);
    return m;
}

/// Sets the rays: lens, shift, and the sample's place within its pixels.
static void setRays(View& view, const Camera& camera) {
    const glm::dvec2 size(view.imageSize);
    double width;  // of the picture at unit depth, or in normalized units
    if (view.orthographic) {
        width = camera.orthographicHeight * view.unit * size.x / size.y;
    } else if (camera.fov > 0) {
        width = 2 * std::tan(glm::radians(camera.fov) / 2);
    } else {
        width = camera.sensorWidth / (camera.focalLength > 0 ? camera.focalLength : 35.0);
    }
    view.rayScale = glm::dvec2(width / size.x);
    // Pixel p sits at (p + 0.5 + jitter − size/2); shift moves the picture by fractions of its longer side.
    const double fine = 1.0 / view.sampling.raster;
    const glm::dvec2 jitter = view.sampling.jitterOf(view.sampling.subFrameOf(view.sample)) * fine,
                     place = (glm::dvec2(view.sampling.placeOnRaster(view.sample)) + 0.5) * fine - 0.5;
    view.rasterOffset = view.rayScale * (jitter - size * 0.5 + camera.shift * std::max(size.x, size.y));
    view.rayOffset = view.rasterOffset + view.rayScale * place;
    view.samplePlace = jitter + place;
}

/// Sets near, far, and the nearest depth.
static void setDepths(View& view, const Camera& camera, const SceneInfo& scene) {
    Bounds depths;
    for (int corner = 0; corner < 8 && !scene.bounds.empty(); ++corner) {
        const glm::dvec3 p(corner & 1 ? scene.bounds.hi.x : scene.bounds.lo.x,
            corner & 2 ? scene.bounds.hi.y : scene.bounds.lo.y, corner & 4 ? scene.bounds.hi.z : scene.bounds.lo.z);
        depths.add(glm::dvec3(0, 0, -view.toView(p).z));
    }
    // Objects may leave the first frame's box later: leave room. Perspective depth depends on neither number.
    const double reach = depths.empty() ? 1 : std::max(depths.hi.z, 0.0);
    view.far = camera.far > 0 ? camera.far * view.unit : reach * 1.5 + 1;
    // Reversed float depth is as precise with a tiny near distance as with a large one.
    view.near = camera.near > 0 ? camera.near * view.unit : view.orthographic ? 0 : std::ldexp(1.0, -24);
    view.nearest = depths.empty() ? 0 : std::max(depths.lo.z, view.near);
    view.clipFar = std::max(reach * 1.5 + 1, 2 * view.near);
}

View makeView(const Camera& camera, const SceneInfo& scene, const ViewRequest& request) {
    View view;
    view.imageSize = request.imageSize;
    view.guard = request.guard;
    view.keptGuard = request.keptGuard;
    view.widestGuard = request.widestGuard;
    const PixelRect picture{glm::ivec2(0), request.imageSize};
    const PixelRect block = request.block.size.x > 0 ? request.block : picture,
                    tile = request.tile.size.x > 0 ? request.tile : block;
    view.canvas = {block.origin - request.guard, block.size + 2 * request.guard};
    view.region = {tile.origin - request.guard, tile.size + 2 * request.guard};
    view.sampling = request.sampling;
    view.sample = request.sample;
    const int samples = request.sampling.samples();
    view.aoSamples = std::min(samples, request.aoSamples > 0 ? request.aoSamples : std::max(4, samples / 2));
    view.lineSamples = std::min(samples, request.lineSamples > 0 ? request.lineSamples : std::max(4, samples / 4));
    view.seed = request.seed;
    view.isBlurred = request.isBlurred;
    view.noiseOnSurface = request.noiseOnSurface;
    view.dpi = request.dpi;
    view.unit = scene.unit();
    view.diagonal = scene.diagonal();
    view.orthographic = camera.orthographicHeight > 0;

    const glm::dmat3 basis = cameraBasis(camera, scene.up);
    const glm::dmat3 toView = glm::transpose(basis);
    view.eye = camera.position;
    view.viewFromRelative = toView * view.unit;

    setRays(view, camera);
    setDepths(view, camera, scene);
    return view;
}

Camera framingCamera(const SceneInfo& scene, glm::ivec2 imageSize, const Reach& reach) {
    Camera camera;
    camera.name = "framing";
    camera.focalLength = 50;
    const glm::dvec3 up = scene.up;
    const glm::dvec3 side = up.y > 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
    const glm::dvec3 right = glm::cross(up, side);
    const glm::dvec3 towards = glm::normalize(0.8 * right + 0.55 * up + side);
    const Bounds& box = scene.bounds;
    camera.lookAt = box.empty() ? glm::dvec3(0) : box.centre();
    camera.position = camera.lookAt + towards * (box.empty() || box.diagonal() == 0 ? 2.0 : 1.0);
    if (box.empty() || box.diagonal() == 0) return camera;
    // A point (x, y, z) in the camera's directions, z towards it, stays within a half angle of tangent t of a camera at
    // (a, b, d) where x - a <= t (d - z) and a - x <= t (d - z): what matters of all points is how far they reach in
    // the directions (1, 0, t) and (-1, 0, t), and in height likewise. Both at once give a and d.
    const glm::dmat3 basis = cameraBasis(camera, up);
    const double wide = 0.85 * camera.sensorWidth / camera.focalLength / 2, high = wide * imageSize.y / imageSize.x;
    struct Sides {
        double after, before;
    };
    const auto sides = [&](int axis, double tangent) {
        return Sides{reach(basis[axis] + tangent * basis[2]), reach(-basis[axis] + tangent * basis[2])};
    };
    const auto distanceFor = [](Sides s, double tangent) { return (s.after + s.before) / (2 * tangent); };
    const Sides across = sides(0, wide), above = sides(1, high);
    const double distance = std::max(distanceFor(across, wide), distanceFor(above, high));
    // In the other direction there is room: the angle that is filled from there is found by going back and forth.
    const auto middleOf = [&](int axis, Sides s, double tangent) {
        for (int i = 0; i < 4 && distanceFor(s, tangent) < distance; ++i) {
            tangent = (s.after + s.before) / (2 * distance);
            s = sides(axis, tangent);
        }
        return (s.after - s.before) / 2;
    };
    const glm::dvec3 middle = basis[0] * middleOf(0, across, wide) + basis[1] * middleOf(1, above, high);
    // Looks at the depth of the box's middle, wherever that lies in the picture.
    camera.lookAt += middle;
    camera.position = camera.lookAt + towards * distance;
    return camera;
}

Light defaultSun(const Camera& camera, const SceneInfo& scene) {
    const glm::dmat3 basis = cameraBasis(camera, scene.up);
    Light light;
    light.name = "sun over the left shoulder";
    light.direction = -glm::normalize(basis * glm::dvec3(-0.6, 0.8, 1.0));
    return light;
}

UniformBlock viewBlock(const View& view) {
    ViewConstants c{};
    c.clipFromView = glm::mat4(view.clipFromView());
    c.worldFromView = glm::mat4(view.worldFromView());
    c.rayScaleExact = view.rayScale;
    c.rayOffsetExact = view.rayOffset;
    c.rayScale = view.rayScale;
    c.rayOffset = view.rayOffset;
    c.samplePlace = view.samplePlace;
    c.canvasSize = view.canvas.size;
    c.placeInCanvas = view.region.origin - view.canvas.origin;
    c.origin = view.region.origin;
    c.size = view.region.size;
    c.placeOnRaster = view.sampling.placeOnRaster(view.sample);
    c.raster = view.sampling.raster;
    c.sample = view.sample;
    c.seed = view.seed;
    c.unit = static_cast<float>(view.unit);
    c.near = static_cast<float>(view.near);
    c.far = static_cast<float>(view.far);
    c.clipFar = static_cast<float>(view.clipFar);
    return makeUniformBlock("view", 0, kViewConstants, &c);
}

}  // namespace limn
