#include "render/renderer.h"

#include "base/install.h"
#include "base/text.h"
#include "frame/directions.h"

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

/// Reads a rectangle of an image back, turned so that rows run from the top.
Image readBack(const gl::Texture& texture, const Aov& aov, const PixelRect& rect) {
    const int channels = aov.channelCount();
    Image image{rect.size.x, rect.size.y, channels, {}};
    if (aov.isDirection) {
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
    return image;
}

/// Depth leaves in scene units, infinite on the background; everything else as it is. Counts values that are not finite
/// before that.
std::uint64_t finish(Image& image, const Aov& aov, double unit) {
    std::atomic<std::uint64_t> bad = 0;
    const bool isDepth = &aov == &aov::depth;
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

/// CPU features that llvmpipe's code depends on, and with it the last bits of its results.
std::string cpuFeatures() {
    std::string text;
    const auto add = [&](bool present, const char* name) {
        if (present) text += (text.empty() ? "" : " ") + std::string(name);
    };
#if defined(__x86_64__)
    __builtin_cpu_init();
    add(__builtin_cpu_supports("avx"), "avx");
    add(__builtin_cpu_supports("avx2"), "avx2");
    add(__builtin_cpu_supports("fma"), "fma");
    add(__builtin_cpu_supports("avx512f"), "avx512f");
#endif
    return text.empty() ? "baseline" : text;
}

}  // namespace

Renderer::Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder)
    : device_(device), shaders_(shaderFolder), executor_(device_, shaders_) {}

/// Compiles the programs of all samples; they differ by what is found anew in them.
void Renderer::prepare(const FramePlan& frame, View view) {
    std::set<std::pair<bool, bool>> kinds;
    for (view.sample = 0; view.sample < view.split.samples(); ++view.sample)
        if (kinds.emplace(view.findsOcclusion(), view.findsLines()).second)
            executor_.prepare(frame.graph, frame.ofSample(view), view);
}

void Renderer::bringScene(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene,
    const SceneFacts& facts, const FramePlans& plans, std::vector<PartTime>& times) {
    SceneKey key = sceneKey(config, loaded, scene, plans.sceneData());
    const auto& materials = loaded.scene.materials;
    const bool changes =
        std::any_of(materials.begin(), materials.end(), [](const auto& material) { return material.moves(); });
    if (gpuScene_ && key == key_ && !changes) return;
    Stopwatch watch(times);
    // Triangles are made while the programs load.
    auto coming = awaited_.valid()
        ? std::move(awaited_)
        : std::async(std::launch::async, [&] { return buildMeshes(config, loaded, scene, key); });
    prepare(plans.averaged, plans.averagedView);
    watch.lap("of which programs");
    SceneMeshes made = coming.get();
    if (made.key != key) made = buildMeshes(config, loaded, scene, key);
    watch.lap("of which triangles, beyond the programs");
    for (const auto& mesh : made.meshes)
        if (facts.triangleBits > 0 && mesh.triangleCount() > std::size_t{1} << facts.triangleBits)
            throw Error(ExitCode::internal, {loaded.scene.file}, "a mesh became more triangles than were planned for",
                "please report this");
    times.push_back({"triangles, begun beside what is above", made.milliseconds});
    gpuScene_ = nullptr;  // gives the old one's memory back first
    gpuScene_ = std::make_unique<GpuScene>(
        scene, made.meshes, made.meshOf, key.needs, device_.limits(), device_.report().isSoftware);
    watch.lap("of which upload");
    rayScene_ = nullptr;
    if (has(key.needs, SceneData::rays)) {
        rayScene_ = std::make_unique<RayScene>(scene, made.meshes, made.meshOf);
        watch.lap("of which ray tracing tree");
    }
    key_ = std::move(key);
}

/// Everything that is drawn of a tile: one image per AOV of the config, of the tile's size (and the guard band that is
/// to be kept).
std::vector<Image> Renderer::drawTile(const Frame& frame, const PixelRect& block, const PixelRect& rect,
    const RenderOptions& options, RenderedFrame& result) {
    const RenderConfig& config = *frame.config;
    const Tile tile{block, rect};
    const FramePlans plans =
        planBoth(config, *frame.scene, *frame.facts, frame.number, frame.largest, options.guard, tile);
    GpuScene& gpu = *gpuScene_;
    prepare(plans.averaged, plans.averagedView);

    executor_.resetMeasurements();
    for (int sample = 0; sample < plans.split.samples(); ++sample) {
        ViewRequest request = viewRequest(config, plans.split, frame.number, plans.guard, options.guard, tile);
        request.sample = sample;
        const View view = makeView(frame.scene->camera, frame.scene->info, request);
        gpu.setView(*frame.scene, view);
        const FramePlan one = planFrame(config, *frame.facts, view, plans.averaged.aovs, frame.number);
        executor_.run(one.graph, one.ofSample(view), view, gpu, rayScene_.get(), options.measure);
    }
    gl::finish();
    passTimes_.clear();
    for (std::size_t i = 0; i < executor_.milliseconds().size(); ++i) {
        const Pass& pass = plans.averaged.graph.passes[static_cast<std::size_t>(plans.averaged.plan.passes[i].pass)];
        passTimes_.push_back({pass.name, pass.slot, executor_.milliseconds()[i]});
    }
    result.view = plans.averagedView;

    std::map<const Aov*, Image> images;
    const auto collect = [&](const FramePlan& plan) {
        for (std::size_t i = 0; i < plan.aovs.size(); ++i) {
            const auto& texture = executor_.texture(plan.plan, plan.wanted[i].resource);
            const bool isWider =
                texture.size().x != rect.size.x && options.guard == 0;  // by a guard band that nobody wants
            Image image = readBack(texture, *plan.aovs[i],
                isWider ? PixelRect{glm::ivec2(plans.guard), rect.size} : PixelRect{glm::ivec2(0), texture.size()});
            result.nonFinite += finish(image, *plan.aovs[i], plans.averagedView.unit);
            images[plan.aovs[i]] = std::move(image);
        }
    };
    collect(plans.averaged);
    if (plans.centre) {
        executor_.resetMeasurements();
        gpu.setView(*frame.scene, plans.centreView);
        executor_.run(plans.centre->graph, plans.centre->plan, plans.centreView, gpu, rayScene_.get(), false);
        collect(*plans.centre);
    }
    std::vector<Image> ordered;
    for (const Aov* aov : config.output.aovs) ordered.push_back(std::move(images[aov]));
    return ordered;
}

RenderedFrame Renderer::render(
    const RenderConfig& config, const LoadedScene& loaded, int number, const RenderOptions& options) {
    RenderedFrame result;
    Stopwatch watch(result.times);
    const DrawScene scene = resolveFrame(loaded, frameRequest(config, number));
    const SceneFacts facts = sceneFacts(scene);
    const int largest = std::min(device_.limits().maxTextureSize, device_.limits().maxViewport);
    const PixelRect firstBlock{glm::ivec2(0), largestBlock(config.image.size)};
    const FramePlans plans = planBoth(config, scene, facts, number, largest, options.guard, {firstBlock, firstBlock});
    if (const auto layout = shadowLayout(scene.lights); std::max(layout.size.x, layout.size.y) > largest)
        throw Error(ExitCode::usage, {loaded.scene.file},
            fmt::format("the shadow maps need a texture of {}×{}, more than this GL device allows ({})", layout.size.x,
                layout.size.y, largest),
            "lower shadow.resolution");
    watch.lap("plan");
    bringScene(config, loaded, scene, facts, plans, result.times);
    watch.lap("scene to the GPU");

    result.opaque = !config.image.transparent;
    const auto& device = device_.report();
    result.metadata = {{"Software", fmt::format("limn {}", kVersion)}, {"limn.config", config.hash},
        {"limn.scene", loaded.hash}, {"limn.frame", std::to_string(number)},
        {"limn.accuracy", std::string(enumNames<Accuracy>[static_cast<std::size_t>(config.accuracy)])},
        {"limn.device", fmt::format("{} | {}", device.renderer, device.version)}, {"limn.cpu", cpuFeatures()},
        {"limn.plan", planSummary(plans.averaged)}};
    for (const Aov* aov : config.output.aovs) {
        Layer layer{std::string(aov->name), {}, aov->isColour, aov->isInteger(), {}};
        for (int c = 0; c < aov->channelCount(); ++c)
            layer.channels.emplace_back(aov->channels[static_cast<std::size_t>(c)]);
        result.layers.push_back(std::move(layer));
    }

    // What is wanted, in pixels from the lower left; tiles begin at multiples of four.
    const glm::ivec2 size = config.image.size;
    const PixelRect wanted = options.crop.size.x > 0
        ? PixelRect{{options.crop.origin.x, size.y - options.crop.origin.y - options.crop.size.y}, options.crop.size}
        : PixelRect{glm::ivec2(0), size};
    const int tileSize = chooseTileSize(config, plans, firstBlock.size);
    const auto cut = [&](int axis, int most) {
        std::vector<std::array<int, 4>> parts;  // of a block and of a tile in it: where they begin and end
        for (const auto& [blockFrom, blockTo] : spans(size[axis], largestBlockSide(size)))
            for (const auto& [from, to] : spans(blockTo - blockFrom, most)) {
                const int low = std::max(blockFrom + from, wanted.origin[axis] / 4 * 4),
                          high = std::min(blockFrom + to,
                              std::min(size[axis], (wanted.origin[axis] + wanted.size[axis] + 3) / 4 * 4));
                if (low < high) parts.push_back({blockFrom, blockTo, low, high});
            }
        return parts;
    };
    // Passes that look everywhere need their whole block, whatever is wanted of it.
    const bool wholeBlocks = tileSize >= std::max(firstBlock.size.x, firstBlock.size.y)
        && (config.accuracy != Accuracy::exact || looksEverywhere(plans.averaged)
            || (plans.centre && looksEverywhere(*plans.centre)));
    const auto columns = cut(0, tileSize), rows = cut(1, tileSize);
    const Frame frame{&config, &scene, &facts, number, largest};
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
        // A band: the part of these tiles that is wanted, rows from the top.
        const int low = std::max((*row)[2], wanted.origin.y),
                  high = std::min((*row)[3], wanted.origin.y + wanted.size.y);
        if (low >= high) continue;
        std::vector<Image> band(config.output.aovs.size());
        for (const auto& column : columns) {
            const PixelRect block{{column[0], (*row)[0]}, {column[1] - column[0], (*row)[1] - (*row)[0]}};
            const PixelRect tile =
                wholeBlocks ? block : PixelRect{{column[2], (*row)[2]}, {column[3] - column[2], (*row)[3] - (*row)[2]}};
            auto images = drawTile(frame, block, tile, options, result);
            const bool isAll = columns.size() == 1 && low == tile.origin.y && high == tile.origin.y + tile.size.y
                && wanted.origin.x == tile.origin.x && wanted.size.x == tile.size.x;
            const int left = std::max(column[2], wanted.origin.x),
                      right = std::min(column[3], wanted.origin.x + wanted.size.x);
            for (std::size_t i = 0; i < images.size(); ++i) {
                if (isAll) {  // with the guard band, if that was asked for
                    band[i] = std::move(images[i]);
                    continue;
                }
                if (band[i].width == 0)
                    band[i] = {wanted.size.x, high - low, images[i].channels,
                        std::vector<float>(static_cast<std::size_t>(wanted.size.x)
                            * static_cast<std::size_t>(high - low) * static_cast<std::size_t>(images[i].channels))};
                for (int y = 0; y < high - low && left < right; ++y) {
                    const float* from = images[i].at(left - tile.origin.x, tile.origin.y + tile.size.y - high + y);
                    std::copy(from, from + static_cast<std::ptrdiff_t>(right - left) * images[i].channels,
                        band[i].at(left - wanted.origin.x, y));
                }
            }
        }
        if (options.onBand) {
            // A few rows at a time: what is made of them on their way into files is then small.
            constexpr int kRows = 128;
            for (int top = 0; top < band.front().height; top += kRows) {
                for (std::size_t i = 0; i < band.size(); ++i)
                    result.layers[i].image =
                        crop(band[i], {{0, top}, {band[i].width, std::min(kRows, band[i].height - top)}});
                options.onBand(result);
            }
            for (auto& layer : result.layers) layer.image = {};
            continue;
        }
        for (std::size_t i = 0; i < band.size(); ++i) {
            Image& image = result.layers[i].image;
            if (image.width == 0)
                image = std::move(band[i]);
            else {
                image.pixels.insert(image.pixels.end(), band[i].pixels.begin(), band[i].pixels.end());
                image.height += band[i].height;
            }
        }
    }
    watch.lap("draw");
    return result;
}

}  // namespace limn
