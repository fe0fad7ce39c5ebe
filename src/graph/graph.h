// What could be drawn (Graph) and what will be (Plan). Pure data and pure functions: no GL here.
//
// A pass declares its reads and writes. It runs if, and only if, a wanted image needs its writes. The same holds for
// each single write: a texture that nobody reads is neither made nor attached.
#pragma once

#include "picture/format.h"
#include "picture/marks.h"
#include "picture/pixel_rect.h"
#include "picture/sampling.h"
#include "picture/view.h"
#include "settings/uniform_block.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn {

/// An image that passes exchange; an index into Graph::resources.
struct ResourceId {
    int index = -1;
    bool operator==(const ResourceId&) const = default;
};

struct Resource {
    std::string name;
    Format format = Format::r32f;
    glm::ivec2 size{0};
    bool persistent = false;  ///< keeps its content from one run to the next
};

/// Data of the scene that shaders read.
enum class SceneData : unsigned {
    none = 0,
    positions = 1,
    normals = 2,
    uvs = 4,
    materials = 8,
    lights = 16,
    textures = 32,
    unifiedVertices = 64,
    rays = 128,
    colors = 256,
    marks = 512,
    coincidence = 1024,
    previous = 2048,
    shadows = 4096,
    triangles = 8192
};
constexpr SceneData operator|(SceneData a, SceneData b) {
    return static_cast<SceneData>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool has(SceneData set, SceneData one) {
    return (static_cast<unsigned>(set) & static_cast<unsigned>(one)) != 0;
}

struct Read {
    std::string name;  ///< of the sampler in the shader
    ResourceId resource;
    int halo = 0;        ///< pixels around its own that the pass wants to read
    bool whole = false;  ///< it may read any pixel: all of the image must be made
};

struct Write {
    std::string name;  ///< of the image or output in the shader
    ResourceId resource;
    SceneData needs = SceneData::none;  ///< scene data read only to write this
    glm::vec4 clear{0};                 ///< raster passes: the value where nothing is drawn
    bool sums = false;                  ///< compute passes: the image sums the writes of all samples of a frame
};

/// One of several drawings of the scene into a raster pass's images, and its place there.
struct RasterView {
    glm::ivec4 viewport{0};  ///< origin and size
    int number = 0;          ///< the shader's uniform `rasterView`
};

/// The scene for host passes. The graph hands it on without knowing its type: rays/ray_scene.h is one,
/// drawing/scene_lines.h another.
struct HostScene {
    virtual ~HostScene() = default;
};

/// What there is of it: each where the plan needs it, else null.
struct HostScenes {
    const HostScene* rays = nullptr;       ///< SceneData::rays: a RayScene
    const HostScene* triangles = nullptr;  ///< SceneData::triangles: a SceneLines
};

/// An image in memory, as host passes see it: rows from the lower left, channels side by side.
struct HostImage {
    glm::ivec2 size{0};
    int channels = 1;
    std::vector<float> values;
};

/// The input and output of a host pass. Images of `writes` that nobody reads are empty.
struct HostWork {
    const View* view = nullptr;  ///< the sample's
    HostScenes scene;
    std::span<const Mark> marks;  ///< where the pass needs SceneData::marks
    std::vector<HostImage> reads, writes;
    PixelRect part;  ///< of the images: only this is wanted
};

/// Side, in pixels, of the squares by which passes are masked: software renderers draw one square at once.
inline constexpr int kMaskTile = 4;

struct Pass {
    /// Compute and raster passes run on the GPU; a host pass runs on the CPU, between reading images back and sending
    /// them on. One that needs marks does not run where there are none: its images are 0.
    enum class Kind { compute, raster, host };
    std::string name;
    std::string slot, technique;
    Kind kind = Kind::compute;
    /// The number of a frame's samples in which it runs (picture/sampling.h). Its images are kept until it runs again,
    /// where a pass reads them that runs in between.
    int rate = kEverySample;
    /// It shows the scene as its lights see it: it runs only where that has changed since its images were made.
    bool isOfLights = false;
    /// The last bits of its images depend on the canvas: its tiles are whole canvases.
    bool isTiedToCanvas = false;
    std::string shader;  ///< path below shaders/ without extension
    std::vector<std::pair<std::string, std::string>> defines;
    std::vector<Read> reads;
    std::vector<Write> writes;  ///< a D32F write of a raster pass is its depth buffer
    UniformBlock params;
    SceneData needs = SceneData::none;
    std::function<void(HostWork&)> work;  ///< host passes
    std::vector<RasterView> rasterViews;  ///< raster passes; empty: the scene once, as the picture's camera sees it
    /// A mask may restrict a compute pass: index into reads of an R8 image, one texel per kMaskTile × kMaskTile pixels.
    /// Where the mask is 0, the pass's images are 0. -1: no mask.
    int mask = -1;
    std::string note;  ///< for people: "8 taps per pixel"
};

struct Graph {
    std::vector<Resource> resources;
    std::vector<Pass> passes;
    std::vector<std::string> absent;  ///< slots that were not asked for, for the explanation
    int samples = 1;                  ///< of a frame

    ResourceId add(Resource resource) {
        resources.push_back(std::move(resource));
        return {static_cast<int>(resources.size()) - 1};
    }
};

/// A wanted result and its name.
struct Wanted {
    std::string name;
    ResourceId resource;
    int halo = 0;  ///< pixels around the picture that are wanted too
};

struct PlannedPass {
    int pass = 0;              ///< index into Graph::passes
    std::vector<bool> writes;  ///< of each Pass::writes: is it made?
    std::string reason;        ///< who asked for it
    int halo = 0;  ///< pixels that it must make around the picture, so that later passes are right up to the border
    bool whole = false;  ///< it must make the whole image, since a later pass may read any pixel
    bool runs = true;    ///< in the plan's run; see narrow()
};

struct CulledPass {
    int pass = 0;
    std::string reason;
};

/// A texture in memory, shared by resources whose lives do not overlap.
struct PhysicalTexture {
    Format format;
    glm::ivec2 size;
    bool persistent = false;
    std::vector<int> resources;  ///< in the order of their lives
    std::uint64_t bytes() const {
        return static_cast<std::uint64_t>(info(format).bytes) * static_cast<std::uint64_t>(size.x)
            * static_cast<std::uint64_t>(size.y);
    }
};

struct Plan {
    std::vector<PlannedPass> passes;  ///< in order of execution
    std::vector<CulledPass> culled;
    std::vector<PhysicalTexture> textures;
    std::vector<int> textureOf;  ///< resource index → index into textures, or −1 when it is not made
    SceneData sceneData = SceneData::none;

    /// The widest halo of all passes: the scene must be drawn that much wider than the picture.
    int halo() const;
    std::uint64_t textureBytes() const;
    bool makes(ResourceId resource) const {
        return resource.index >= 0 && textureOf[static_cast<std::size_t>(resource.index)] >= 0;
    }
};

/// Culls and orders passes, and lays resources out in as few textures as their lifetimes allow. Throws Errors
/// (internal) naming *every* resource that is read but not written, written twice, or part of a cycle.
Plan compile(const Graph& graph, std::span<const Wanted> wanted);

/// The plan of one run, in which only some passes are due. Per-sample passes make only what the due passes and `wanted`
/// read. Passes and textures keep their places.
Plan narrow(
    const Graph& graph, Plan plan, std::span<const Wanted> wanted, const std::function<bool(const Pass&)>& isDue);

/// Facts about a picture that the explanation shows above the passes: name and value.
using PlanFacts = std::vector<std::pair<std::string, std::string>>;
enum class PlanFormat { text, json, dot };

/// `milliseconds`: of each planned pass, empty when not measured.
std::string explain(const Graph& graph, const Plan& plan, PlanFormat format, const PlanFacts& facts,
    std::span<const double> milliseconds = {});

}  // namespace limn
