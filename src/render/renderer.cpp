#include "render/renderer.h"

#include "base/install.h"
#include "base/memory.h"
#include "base/text.h"
#include "picture/directions.h"
#include "stage/shadow_layout.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>

namespace limn {
namespace {

class Stopwatch {
public:
    explicit Stopwatch(std::vector<PartTime>& times) : times_(times) {}
    void lap(std::string name) {
        const auto now = std::chrono::steady_clock::now();
        times_.push_back({std::move(name), std::chrono::duration<double, std::milli>(now - last_).count()});
        last_ = now;
    }

private:
    std::vector<PartTime>& times_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::vector<float> decodeDirections(const std::vector<float>& encoded) {
    std::vector<float> decoded(encoded.size() / 2 * 3);
    tbb::parallel_for(std::size_t{0}, encoded.size() / 2, [&](std::size_t i) {
        const glm::vec3 n = decodeDirection({encoded[2 * i], encoded[2 * i + 1]});
        for (int k = 0; k < 3; ++k) decoded[3 * i + static_cast<std::size_t>(k)] = n[k];
    });
    return decoded;
}

/// Reads a rectangle of an image back, with rows from the top. A sum of samples becomes their mean.
Image readBack(const gl::Texture& texture, const Aov& aov, int summed, const PixelRect& rect) {
    const int channels = aov.channelCount();
    Image image{rect.size.x, rect.size.y, channels, {}};
    if (aov.kind == AovKind::direction) {
        image.pixels = decodeDirections(texture.read(2, rect.origin, rect.size));
    } else if (aov.isInteger()) {
        const auto integers = texture.readIntegers(channels, rect.origin, rect.size);
        image.pixels.assign(integers.begin(), integers.end());
    } else {
        image.pixels = texture.read(channels, rect.origin, rect.size);
    }
    const auto row = static_cast<std::ptrdiff_t>(image.width) * channels;
    tbb::parallel_for(0, image.height / 2,
        [&](int y) { std::swap_ranges(image.at(0, y), image.at(0, y) + row, image.at(0, image.height - 1 - y)); });
    if (summed == 1) return image;
    const float count = static_cast<float>(summed);
    tbb::parallel_for(0, image.height, [&](int y) {
        for (float* p = image.at(0, y); p != image.at(0, y) + row; ++p) *p /= count;
    });
    return image;
}

/// Turns depth into scene units, infinite on the background, and leaves other images as they are. First counts values
/// that are not finite.
std::uint64_t finish(Image& image, const Aov& aov, double unit) {
    std::atomic<std::uint64_t> bad = 0;
    const bool isDepth = aov.kind == AovKind::depth;
    tbb::parallel_for(0, image.height, [&](int y) {
        std::uint64_t badHere = 0;
        float* p = image.at(0, y);
        for (int i = 0; i < image.width * image.channels; ++i, ++p) {
            badHere += !std::isfinite(*p);
            if (isDepth)
                *p = *p == kBackgroundDepth ? std::numeric_limits<float>::infinity() : static_cast<float>(*p / unit);
        }
        bad += badHere;
    });
    return bad;
}

Image crop(const Image& image, const PixelRect& rect) {
    Image part{rect.size.x, rect.size.y, image.channels, {}};
    part.pixels.reserve(static_cast<std::size_t>(rect.size.x) * static_cast<std::size_t>(rect.size.y)
        * static_cast<std::size_t>(image.channels));
    for (int y = 0; y < rect.size.y; ++y) {
        const float* row = image.at(rect.origin.x, rect.origin.y + y);
        part.pixels.insert(part.pixels.end(), row, row + rect.size.x * image.channels);
    }
    return part;
}

/// Copies the part of a tile's image that lies in a band: columns from `left` to `right` of the picture.
void putIntoBand(
    Image& band, const Image& image, const PixelRect& tile, const PixelRect& bandRect, int left, int right) {
    if (band.width == 0) {
        band = {bandRect.size.x, bandRect.size.y, image.channels, {}};
        band.pixels.resize(static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height)
            * static_cast<std::size_t>(band.channels));
    }
    const int skipped = tile.origin.y + tile.size.y - bandRect.origin.y - bandRect.size.y;  // its rows above the band
    for (int y = 0; y < bandRect.size.y && left < right; ++y) {
        const float* from = image.at(left - tile.origin.x, skipped + y);
        std::copy(from, from + static_cast<std::ptrdiff_t>(right - left) * image.channels,
            band.at(left - bandRect.origin.x, y));
    }
}

/// Hands a band on, or adds it to the frame's images.
void takeBand(std::vector<Image>&& band, const RenderOptions& options, RenderedFrame& result) {
    if (!options.onBand) {
        for (std::size_t i = 0; i < band.size(); ++i) {
            Image& image = result.layers[i].image;
            if (image.width == 0) {
                image = std::move(band[i]);
                continue;
            }
            image.pixels.insert(image.pixels.end(), band[i].pixels.begin(), band[i].pixels.end());
            image.height += band[i].height;
        }
        return;
    }
    // Hands a few rows on at a time, which keeps encoders' buffers small.
    const int rows = std::clamp((1 << 20) / band.front().width, 16, 128);
    for (int top = 0; top < band.front().height; top += rows) {
        for (std::size_t i = 0; i < band.size(); ++i)
            result.layers[i].image = crop(band[i], {{0, top}, {band[i].width, std::min(rows, band[i].height - top)}});
        options.onBand(result);
    }
    for (auto& layer : result.layers) layer.image = {};
}

MeshNeeds meshNeeds(SceneData needs) {
    return {has(needs, SceneData::normals), has(needs, SceneData::uvs), has(needs, SceneData::unifiedVertices),
        has(needs, SceneData::colors)};
}

/// Are meshes kept in memory for passes on the CPU?
bool readsTriangles(SceneData needs) { return has(needs, SceneData::rays) || has(needs, SceneData::triangles); }

Layer emptyLayer(const Aov& aov) {
    Layer layer{std::string(aov.name), {}, aov.isColour(), aov.isInteger(), {}};
    for (int c = 0; c < aov.channelCount(); ++c) layer.channels.emplace_back(aov.channels[static_cast<std::size_t>(c)]);
    return layer;
}

}  // namespace

Renderer::Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder)
    : device_(device),
      shaders_(shaderFolder),
      executor_(device_, shaders_),
      gpuScene_(device_.limits(), device_.report().isSoftware),
      shadersKey_(shadersKey(shaderFolder)) {}

int Renderer::largestTexture() const { return std::min(device_.limits().maxTextureSize, device_.limits().maxViewport); }

void Renderer::prepare(const Pipeline& pipeline, View view) {
    // Samples differ in the passes that run in them.
    std::set<std::vector<bool>> kinds;
    for (view.sample = 0; view.sample < view.sampling.samples(); ++view.sample) {
        std::vector<bool> runs;
        for (const auto& planned : pipeline.plan.passes)
            runs.push_back(view.runs(pipeline.graph.passes[static_cast<std::size_t>(planned.pass)].rate));
        if (kinds.insert(runs).second) executor_.prepare(pipeline.graph, pipeline.ofSample(view), view);
    }
}

bool Renderer::Held::contains(const ContentKey& order) const {
    const auto known = shownAs.find(order);
    return meshes.contains(known == shownAs.end() ? order : known->second);
}

Renderer::Held Renderer::held() const { return {gpuScene_.residents(), shownAs_}; }

ContentKey Renderer::shownAs(const ContentKey& order) const {
    const auto known = shownAs_.find(order);
    return known == shownAs_.end() ? order : known->second;
}

MadeMeshes Renderer::makeMissing(
    Frame& frame, const TilePipelines& pipelines, const MeshOrders& orders, std::vector<PartTime>& times) {
    const bool keeps = readsTriangles(pipelines.sceneData());
    const auto isMissing = [&](const MeshOrder& order) {
        const ContentKey key = shownAs(order.key);
        return !gpuScene_.holds(key) || (keeps && !hostMeshes_.contains(key));
    };
    const auto make = [&](const auto& isWanted) {
        return makeMeshes(frame.loaded, frame.scene, frame.request, orders, isWanted);
    };
    if (std::none_of(orders.orders.begin(), orders.orders.end(), isMissing)) return {};
    Stopwatch watch(times);
    // Makes triangles while the programs load.
    bool isAhead = frame.awaited.valid();
    auto coming = isAhead ? std::move(frame.awaited) : std::async(std::launch::async, [&] { return make(isMissing); });
    prepare(pipelines.averaged, pipelines.averagedView);
    watch.lap("of which programs");
    MadeMeshes made = coming.get();
    const auto isStillMissing = [&](const MeshOrder& order) {
        return isMissing(order) && !made.meshes.contains(order.key) && !made.shownAs.contains(order.key);
    };
    if (std::any_of(orders.orders.begin(), orders.orders.end(), isStillMissing)) {
        isAhead = false;
        MadeMeshes more = make(isStillMissing);
        made.meshes.merge(more.meshes);
        made.shownAs.merge(more.shownAs);
    }
    watch.lap("of which waiting for triangles");
    for (const auto& [key, mesh] : made.meshes)
        if (frame.facts.triangleBits > 0 && mesh.triangleCount() > std::size_t{1} << frame.facts.triangleBits)
            throw Error(ExitCode::internal, {frame.loaded.scene.file},
                "a mesh became more triangles than were planned for", "please report this");
    times.push_back({isAhead ? "triangles (made ahead)" : "triangles (made in parallel)", made.milliseconds});
    return made;
}

bool Renderer::bringRays(const Frame& frame, std::span<const ContentKey> meshOf) {
    const SceneInfo& info = frame.scene.info;
    KeyBuilder key;
    key.add(info.unit()).bytes(&info.bounds.lo, sizeof info.bounds.lo);
    std::vector<const TriMesh*> meshes;
    for (std::size_t i = 0; i < meshOf.size(); ++i) {
        const DrawInstance& instance = frame.scene.instances[i];
        meshes.push_back(&hostMeshes_.at(meshOf[i]));
        key.add(meshOf[i].low).add(meshOf[i].high).bytes(&instance.worldFromMesh, sizeof instance.worldFromMesh);
        for (const auto material : instance.materials) {  // its images may cut holes
            const ContentKey& texture = frame.scene.textureKeys[material];
            key.add(texture.low).add(texture.high);
            const Material& look = frame.scene.materials[material];
            if (look.cutout.empty()) continue;
            key.add(look.textureScale.x).add(look.textureScale.y).add(look.textureOffset.x).add(look.textureOffset.y);
            key.add(look.textureRepeats).add(look.textureFilter);
        }
    }
    if (rayScene_ && key.key() == rayKey_) return false;
    rayScene_ = nullptr;
    rayScene_ = std::make_unique<RayScene>(frame.scene, meshes);
    rayKey_ = key.key();
    return true;
}

void Renderer::bringEdges(const Frame& frame, std::span<const ContentKey> meshOf) {
    std::vector<const TriMesh*> meshes;
    std::vector<const TriangleEdges*> edges;
    meshes.reserve(meshOf.size());
    edges.reserve(meshOf.size());
    for (const ContentKey& key : meshOf) {
        meshes.push_back(&hostMeshes_.at(key));
        const auto [found, isNew] = edges_.try_emplace(key);
        if (isNew) found->second = findTriangleEdges(*meshes.back());
        edges.push_back(&found->second);
    }
    sceneLines_ = std::make_unique<SceneLines>(frame.scene, std::move(meshes), std::move(edges));
}

void Renderer::bringScene(Frame& frame, const TilePipelines& pipelines, std::vector<PartTime>& times) {
    const SceneData needs = pipelines.sceneData();
    gpuScene_.require(needs, frame.scene.lineRecords.size());
    if (!readsTriangles(needs)) hostMeshes_.clear();
    const MeshOrders orders = orderMeshes(frame.loaded, frame.scene, frame.request, meshNeeds(needs));
    MadeMeshes made = makeMissing(frame, pipelines, orders, times);
    shownAs_.merge(made.shownAs);
    std::vector<ContentKey> meshOf;
    std::set<ContentKey> asked;
    for (const std::size_t order : orders.orderOf) {
        meshOf.push_back(shownAs(orders.orders[order].key));
        asked.insert(orders.orders[order].key);
    }
    std::erase_if(shownAs_, [&](const auto& entry) { return !asked.contains(entry.first); });
    Stopwatch watch(times);
    gpuScene_.update(frame.scene, meshOf, made.meshes);
    watch.lap("of which upload");
    if (readsTriangles(needs)) hostMeshes_.merge(made.meshes);
    const std::set<ContentKey> wanted(meshOf.begin(), meshOf.end());
    std::erase_if(hostMeshes_, [&](const auto& entry) { return !wanted.contains(entry.first); });
    std::erase_if(edges_, [&](const auto& entry) { return !hostMeshes_.contains(entry.first); });
    if (!has(needs, SceneData::rays)) rayScene_ = nullptr;
    if (has(needs, SceneData::rays) && bringRays(frame, meshOf)) watch.lap("of which ray tracing tree");
    sceneLines_ = nullptr;
    if (!has(needs, SceneData::triangles)) return edges_.clear();
    bringEdges(frame, meshOf);
    watch.lap("of which edges of meshes");
}

void Renderer::tellProgress(const Frame& frame, const RenderOptions& options, int sample, int samples) {
    using namespace std::chrono;
    if (!options.onProgress || steady_clock::now() - toldAt_ < milliseconds(500)) return;
    // What has been sent to the device is not drawn yet; waiting for it this seldom costs nothing.
    gl::finish();
    toldAt_ = steady_clock::now();
    options.onProgress((frame.tilesDone + static_cast<double>(sample) / samples) / frame.tiles);
}

/// The moments that a frame's samples show.
static std::vector<double> momentsOf(const RenderConfig& config, int frame) {
    const Sampling sampling{1, config.image.samples};
    std::vector<double> moments;
    moments.reserve(static_cast<std::size_t>(sampling.samples()));
    for (int sample = 0; sample < sampling.samples(); ++sample)
        moments.push_back(frame + config.image.shutter * sampling.timeOf(sample));
    return moments;
}

void Renderer::addMoments(Frame& frame) {
    for (const double time : momentsOf(frame.config, frame.number)) {
        FrameRequest request = frame.request;
        request.frame = time;
        const SceneAt scene = sceneAt(frame.loaded, request);
        addFacts(frame.facts, sceneFacts(scene));
        KeyBuilder key;
        key.add(frame.scene.key.low).add(frame.scene.key.high).add(scene.key.low).add(scene.key.high);
        frame.scene.key = key.key();
    }
}

void Renderer::moveTo(Frame& frame, const TilePipelines& pipelines, double time) {
    FrameRequest request = frame.request;
    request.frame = time;
    frame.scene = sceneAt(frame.loaded, request);
    pointAt(frame.facts, frame.scene);
    std::vector<PartTime> times;
    bringScene(frame, pipelines, times);
}

void Renderer::setView(const Frame& frame, const View& view, const ViewRequest& request) {
    gpuScene_.setView(frame.scene, view);
    if (frame.previous)
        gpuScene_.setPrevious(
            frame.scene, *frame.previous, makeView(frame.previous->camera, frame.previous->info, request));
}

void Renderer::drawSamples(
    Frame& frame, const Tile& tile, const TilePipelines& pipelines, const RenderOptions& options) {
    const Pipeline& pipeline = pipelines.averaged;
    executor_.resetMeasurements();
    for (int sample = 0; sample < pipelines.sampling.samples(); ++sample) {
        ViewRequest request =
            viewRequest(frame.config, pipelines.sampling, frame.number, pipelines.guard, options.guard, tile);
        request.sample = sample;
        if (request.isBlurred)
            moveTo(frame, pipelines, frame.number + frame.config.image.shutter * pipelines.sampling.timeOf(sample));
        const View view = makeView(frame.scene.camera, frame.scene.info, request);
        setView(frame, view, request);
        executor_.run(pipeline.graph, pipeline.ofSample(view), view, gpuScene_, hostScenes(), options.measure);
        tellProgress(frame, options, sample + 1, pipelines.sampling.samples());
    }
    if (pipelines.averagedView.isBlurred) moveTo(frame, pipelines, frame.number);
    gl::finish();
    passTimes_.clear();
    for (std::size_t i = 0; i < executor_.milliseconds().size(); ++i) {
        const Pass& pass = pipeline.graph.passes[static_cast<std::size_t>(pipeline.plan.passes[i].pass)];
        passTimes_.push_back({pass.name, pass.slot, executor_.milliseconds()[i]});
    }
}

std::vector<Image> Renderer::drawTile(
    Frame& frame, const Tile& tile, const RenderOptions& options, RenderedFrame& result) {
    const RenderConfig& config = frame.config;
    const TilePipelines pipelines =
        buildPipelines(config, frame.scene, frame.facts, frame.number, largestTexture(), options.guard, tile);
    prepare(pipelines.averaged, pipelines.averagedView);
    drawSamples(frame, tile, pipelines, options);
    result.view = pipelines.averagedView;

    std::map<const Aov*, Image> images;
    const auto collect = [&](const Pipeline& pipeline) {
        for (std::size_t i = 0; i < pipeline.aovs.size(); ++i) {
            const auto& texture = executor_.texture(pipeline.plan, pipeline.wanted[i].resource);
            // The image has a guard band that nobody wants.
            const bool isWider = texture.size().x != tile.rect.size.x && options.guard == 0;
            const PixelRect rect = isWider ? PixelRect{glm::ivec2(pipelines.guard), tile.rect.size}
                                           : PixelRect{glm::ivec2(0), texture.size()};
            Image image = readBack(texture, *pipeline.aovs[i], pipeline.summed[i], rect);
            result.nonFinite += finish(image, *pipeline.aovs[i], pipelines.averagedView.unit);
            images[pipeline.aovs[i]] = std::move(image);
        }
    };
    collect(pipelines.averaged);
    if (pipelines.centre) {
        executor_.resetMeasurements();
        setView(frame, pipelines.centreView,
            viewRequest(config, pipelines.centreView.sampling, frame.number, pipelines.guard, options.guard, tile));
        executor_.run(
            pipelines.centre->graph, pipelines.centre->plan, pipelines.centreView, gpuScene_, hostScenes(), false);
        collect(*pipelines.centre);
    }
    std::vector<Image> ordered;
    for (const Aov* aov : config.output.aovs) ordered.push_back(std::move(images[aov]));
    return ordered;
}

void Renderer::checkShadows(const SceneAt& scene, const std::string& file) const {
    const ShadowLayout shadows = shadowLayout(scene.lights);
    if (shadows.maps.empty()) return;
    const std::uint64_t bytes = sizeof(float) * static_cast<std::uint64_t>(shadows.size.x) * shadows.size.y;
    const std::string what = fmt::format("the shadows of {} light{} take {} maps", scene.lights.size(),
        scene.lights.size() == 1 ? "" : "s", shadows.maps.size());
    const char* const remedy = "lower shadow.resolution, or leave shadow out of some lights; a point light takes six";
    if (std::max(shadows.size.x, shadows.size.y) > largestTexture())
        throw Error(ExitCode::outOfMemory, {file},
            fmt::format("{}, {} in one texture of {}×{} texels; this GL device allows {} each way", what,
                bytesText(bytes), shadows.size.x, shadows.size.y, largestTexture()),
            remedy);
    const MemoryClaim claim(bytes, {file}, what, remedy);
}

/// What is to be drawn of a picture, in pixels from the lower left; `crop` counts from the upper left.
static PixelRect wantedPart(const PixelRect& crop, glm::ivec2 size) {
    if (crop.size.x <= 0) return {glm::ivec2(0), size};
    return {{crop.origin.x, size.y - crop.origin.y - crop.size.y}, crop.size};
}

/// A band as it is drawn, as it is encoded, and a tile of it on its way from the device.
static std::uint64_t bandBytes(const std::vector<Layer>& layers, int width, int rows) {
    std::uint64_t channels = 0;
    for (const auto& layer : layers) channels += layer.channels.size();
    return 3 * sizeof(float) * channels * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(rows);
}

FrameIdentity Renderer::identify(
    const RenderConfig& config, const LoadedScene& loaded, int number, const PixelRect& crop) const {
    Frame frame{config, loaded, frameRequest(config, number), {}, {}, {}, number, {}};
    frame.scene = sceneAt(loaded, frame.request);
    frame.facts = sceneFacts(frame.scene);
    if (config.image.shutter > 0) addMoments(frame);
    const SceneAt& scene = frame.scene;
    const PixelRect block{glm::ivec2(0), largestBlock(config.image.size)};
    const TilePipelines pipelines =
        buildPipelines(config, scene, frame.facts, number, largestTexture(), 0, {block, block});
    return {metadataOf(config, scene, number, crop, device_.report(), shadersKey_, pipelines.averaged),
        pixelsKey(config, scene, number)};
}

void Renderer::drawBands(
    Frame& frame, const TilePipelines& pipelines, const RenderOptions& options, RenderedFrame& result) {
    const RenderConfig& config = frame.config;
    const glm::ivec2 size = config.image.size;
    // Tiles begin at multiples of four.
    const PixelRect wanted = wantedPart(options.crop, size);
    const int tileSize = chooseTileSize(config, pipelines, largestBlock(size));
    // A block that cannot be cut is drawn whole, whatever is wanted of it.
    const bool wholeBlocks = !takesAnyTile(pipelines);
    const auto columns = tileSpans(size, 0, tileSize, wanted), rows = tileSpans(size, 1, tileSize, wanted);
    const int bandRows = std::min(std::max(tileSize, 1), size.y);
    const MemoryClaim claim(bandBytes(result.layers, wanted.size.x, bandRows), {config.file.string()},
        fmt::format("a band of the picture has {} rows of {} pixels", bandRows, wanted.size.x),
        "make the picture smaller, or set image.tile to a smaller size");
    frame.tiles = static_cast<double>(columns.size() * rows.size());
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
        // A band: the wanted part of these tiles, rows from the top.
        const int low = std::max(row->from, wanted.origin.y), high = std::min(row->to, wanted.origin.y + wanted.size.y);
        if (low >= high) continue;
        const PixelRect bandRect{{wanted.origin.x, low}, {wanted.size.x, high - low}};
        std::vector<Image> band(config.output.aovs.size());
        for (const auto& column : columns) {
            const PixelRect block{
                {column.blockFrom, row->blockFrom}, {column.blockTo - column.blockFrom, row->blockTo - row->blockFrom}};
            const PixelRect rect = wholeBlocks
                ? block
                : PixelRect{{column.from, row->from}, {column.to - column.from, row->to - row->from}};
            auto images = drawTile(frame, {block, rect}, options, result);
            ++frame.tilesDone;
            // Includes the guard band, if that was asked for.
            const bool isAll = columns.size() == 1 && bandRect.origin == rect.origin && bandRect.size == rect.size;
            const int left = std::max(column.from, wanted.origin.x),
                      right = std::min(column.to, wanted.origin.x + wanted.size.x);
            for (std::size_t i = 0; i < images.size(); ++i)
                if (isAll)
                    band[i] = std::move(images[i]);
                else
                    putIntoBand(band[i], images[i], rect, bandRect, left, right);
        }
        takeBand(std::move(band), options, result);
    }
}

std::shared_ptr<const Drawing> Renderer::drawVectors(const Frame& frame, const View& view) const {
    auto drawing = std::make_shared<Drawing>();
    drawing->size = frame.config.image.size;
    drawing->dpi = frame.config.image.dpi;
    const SceneAt& scene = frame.scene;
    drawing->records = scene.lineRecords;
    for (const auto& material : scene.materials) drawing->materials.push_back(material.name);
    for (const auto& instance : scene.instances) {
        Drawing::Object object{std::string(instance.name), {}};
        for (const auto& part : instance.parts) object.parts.push_back(part);
        drawing->objects.push_back(std::move(object));
    }
    for (const auto& choice : frame.config.in("edges")) {
        if (!choice.technique->vectorLines) continue;
        const LineLayer layer = choice.technique->vectorLines(view, choice.at(frame.number).get());
        if (layer.look.opacity <= 0 || layer.look.widest() <= 0) continue;
        drawing->layers.push_back({sceneLines_->lines(view, layer.request), layer.look});
    }
    return drawing;
}

RenderedFrame Renderer::render(
    const RenderConfig& config, const LoadedScene& loaded, int number, const RenderOptions& options) {
    RenderedFrame result;
    Stopwatch watch(result.times);
    Frame frame{config, loaded, frameRequest(config, number), {}, {}, {}, number, std::move(awaited_)};
    frame.scene = sceneAt(loaded, frame.request);
    frame.facts = sceneFacts(frame.scene);
    if (config.image.shutter > 0) addMoments(frame);
    const PixelRect firstBlock{glm::ivec2(0), largestBlock(config.image.size)};
    const TilePipelines pipelines = buildPipelines(
        config, frame.scene, frame.facts, number, largestTexture(), options.guard, {firstBlock, firstBlock});
    checkShadows(frame.scene, loaded.scene.file);
    if (has(pipelines.sceneData(), SceneData::previous)) {
        FrameRequest before = frame.request;
        const auto& declared = config.frames ? config.frames : loaded.scene.frames;
        before.frame = declared && number > declared->first ? number - 1 : number;
        frame.previous = sceneAt(loaded, before);
    }
    watch.lap("plan");
    bringScene(frame, pipelines, result.times);
    watch.lap("scene to the GPU");
    if (options.onScene) options.onScene();

    result.opaque = !config.image.transparent;
    result.metadata =
        metadataOf(config, frame.scene, number, options.crop, device_.report(), shadersKey_, pipelines.averaged);
    for (const Aov* aov : config.output.aovs) result.layers.push_back(emptyLayer(*aov));

    if (config.output.isVector()) result.drawing = drawVectors(frame, pipelines.averagedView);
    drawBands(frame, pipelines, options, result);
    watch.lap("draw");
    return result;
}

MadeMeshes makeMeshesOf(const RenderConfig& config, const LoadedScene& loaded, int frame, const Renderer::Held& held) {
    const FrameRequest request = frameRequest(config, frame);
    const SceneAt scene = sceneAt(loaded, request);
    const PixelRect block{glm::ivec2(0), largestBlock(config.image.size)};
    const TilePipelines pipelines =
        buildPipelines(config, scene, sceneFacts(scene), frame, kAnyTexture, 0, {block, block});
    const MeshOrders orders = orderMeshes(loaded, scene, request, meshNeeds(pipelines.sceneData()));
    return makeMeshes(
        loaded, scene, request, orders, [&](const MeshOrder& order) { return !held.contains(order.key); });
}

}  // namespace limn
