#include "render/renderer.h"

#include "base/file.h"
#include "base/install.h"
#include "base/log.h"
#include "base/text.h"
#include "frame/directions.h"
#include "geometry/section.h"
#include "render/edge_rates.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <cmath>

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

ViewRequest viewRequest(const RenderConfig& config, const SampleSplit& split, int frame, int guard, int keptGuard) {
    ViewRequest request;
    request.imageSize = config.image.size;
    request.split = split;
    request.seed = config.image.seedIsFrame ? static_cast<unsigned>(frame) : config.image.seed;
    request.dpi = config.image.dpi;
    request.guard = guard;
    request.keptGuard = keptGuard;
    request.widestGuard = static_cast<int>(std::ceil(config.image.guard * std::max(config.image.size.x, config.image.size.y)));
    return request;
}

std::vector<float> decodeDirections(const std::vector<float>& encoded) {
    std::vector<float> decoded(encoded.size() / 2 * 3);
    tbb::parallel_for(std::size_t{0}, encoded.size() / 2, [&](std::size_t i) {
        const glm::vec3 n = decodeDirection({encoded[2 * i], encoded[2 * i + 1]});
        for (int k = 0; k < 3; ++k) decoded[3 * i + static_cast<std::size_t>(k)] = n[k];
    });
    return decoded;
}

/// Reads an image back, turned so that rows run from the top.
Image readBack(const gl::Texture& texture, const Aov& aov) {
    const int channels = aov.channelCount();
    Image image{texture.size().x, texture.size().y, channels, {}};
    const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(channels);
    image.pixels.resize(row * static_cast<std::size_t>(image.height));
    const auto flip = [&](const auto& pixels) {
        tbb::parallel_for(0, image.height, [&](int y) {
            const auto from = row * static_cast<std::size_t>(image.height - 1 - y);
            for (std::size_t i = 0; i < row; ++i) image.pixels[row * static_cast<std::size_t>(y) + i] = static_cast<float>(pixels[from + i]);
        });
    };
    if (aov.isDirection) flip(decodeDirections(texture.read(2)));
    else if (aov.isInteger()) flip(texture.readIntegers(channels));
    else flip(texture.read(channels));
    return image;
}

/// Depth leaves in scene units, infinite on the background; everything else as it is. Counts values that are not finite before that.
std::uint64_t finish(Image& image, const Aov& aov, double unit) {
    std::atomic<std::uint64_t> bad = 0;
    const bool isDepth = &aov == &aov::depth;
    tbb::parallel_for(0, image.height, [&](int y) {
        std::uint64_t badHere = 0;
        float* p = image.at(0, y);
        for (int i = 0; i < image.width * image.channels; ++i, ++p) {
            badHere += !std::isfinite(*p);
            if (isDepth) *p = *p == kBackgroundDepth ? std::numeric_limits<float>::infinity() : static_cast<float>(*p / unit);
        }
        bad += badHere;
    });
    return bad;
}

Image crop(const Image& image, const PixelRect& rect) {
    Image part{rect.size.x, rect.size.y, image.channels, {}};
    for (int y = 0; y < rect.size.y; ++y) {
        const float* row = image.at(rect.origin.x, rect.origin.y + y);
        part.pixels.insert(part.pixels.end(), row, row + rect.size.x * image.channels);
    }
    return part;
}

std::string planSummary(const FramePlan& frame) {
    std::string text;
    for (const auto& planned : frame.plan.passes) text += (text.empty() ? "" : " ") + frame.graph.passes[static_cast<std::size_t>(planned.pass)].name;
    return text;
}

/// CPU features that llvmpipe's code depends on, and with it the last bits of its results.
std::string cpuFeatures() {
    std::string text;
    const auto add = [&](bool present, const char* name) { if (present) text += (text.empty() ? "" : " ") + std::string(name); };
#if defined(__x86_64__)
    __builtin_cpu_init();
    add(__builtin_cpu_supports("avx"), "avx");
    add(__builtin_cpu_supports("avx2"), "avx2");
    add(__builtin_cpu_supports("fma"), "fma");
    add(__builtin_cpu_supports("avx512f"), "avx512f");
#endif
    return text.empty() ? "baseline" : text;
}

SceneData neededData(const Plan& a, const std::optional<FramePlan>& b) { return b ? a.sceneData | b->plan.sceneData : a.sceneData; }

/// Cuts every instance that a section reaches; it then has a mesh of its own.
void cutOpen(const LoadedScene& loaded, const DrawScene& scene, const MeshNeeds& needs, std::vector<TriMesh>& meshes, std::vector<int>& meshOf) {
    std::vector<TriMesh> cut(scene.instances.size());
    std::vector<char> isOwn(scene.instances.size());
    std::vector<std::size_t> open(scene.instances.size());
    tbb::parallel_for(std::size_t{0}, scene.instances.size(), [&](std::size_t i) {
        const DrawInstance& instance = scene.instances[i];
        const TriMesh* mesh = &meshes[static_cast<std::size_t>(meshOf[i])];
        const PolyMesh& poly = loaded.meshes[static_cast<std::size_t>(instance.mesh)].poly;
        const glm::dmat3 linear(instance.worldFromMesh);
        const glm::dvec3 pivot(instance.worldFromMesh * glm::dvec4(mesh->pivot, 1));
        for (std::size_t s = 0; s < scene.sections.size(); ++s) {
            const SectionPlane& section = scene.sections[s];
            const CutPlane plane{glm::transpose(linear) * section.normal, glm::dot(section.normal, pivot - section.point), static_cast<std::uint32_t>(poly.materialNames.size() + s), static_cast<std::uint32_t>(poly.partNames.size())};
            if (!isCut(*mesh, plane)) continue;
            CutMesh done = cutMesh(*mesh, plane, needs);
            open[i] += done.openOutlines;
            cut[i] = std::move(done.mesh);
            mesh = &cut[i];
            isOwn[i] = true;
        }
        if (isOwn[i] && !needs.unified) numberByLastVertex(cut[i]);
    });
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (open[i] > 0) log::warning("object '{}' is not closed where a section cuts it: {} outline{} without a cut face", scene.instances[i].name, open[i], open[i] == 1 ? "" : "s");
        if (!isOwn[i]) continue;
        meshOf[i] = static_cast<int>(meshes.size());
        meshes.push_back(std::move(cut[i]));
    }
    // What only cut instances showed is no longer needed.
    std::vector<char> used(meshes.size());
    for (const int mesh : meshOf) used[static_cast<std::size_t>(mesh)] = true;
    for (std::size_t m = 0; m < meshes.size(); ++m)
        if (!used[m]) meshes[m] = {};
}

/// Both plans of a frame: the averaged AOVs over all samples, and the others at the pixel's centre.
struct FramePlans {
    SampleSplit split;
    int guard = 0;
    FramePlan averaged;
    std::optional<FramePlan> centre;
    View averagedView, centreView;
};

FramePlans planBoth(const RenderConfig& config, const DrawScene& scene, const SceneFacts& facts, int frame, int maxTextureSize, int keptGuard) {
    FramePlans plans;
    auto averaged = chooseAovs(config.output.aovs, true);
    const auto centre = chooseAovs(config.output.aovs, false);
    // Without anything to average one look at the pixel's centre is all there is to do.
    const bool together = averaged.empty() || config.image.samples == 1;
    const auto plan = [&] {
        plans.averagedView = makeView(scene.camera, scene.info, viewRequest(config, plans.split, frame, plans.guard, keptGuard));
        plans.averaged = planFrame(config, facts, plans.averagedView, together ? std::span(config.output.aovs) : std::span<const Aov* const>(averaged), frame);
    };
    if (averaged.empty()) plans.split = {};
    else plans.split = {1, config.image.samples};
    // The first plan tells how wide a guard band is needed, and whether a finer raster is of use.
    plan();
    plans.guard = plans.averaged.plan.halo();
    if (plans.averaged.usesFineRaster) plans.split = splitSamples(plans.split.samples(), config.image.size + 2 * plans.guard, maxTextureSize);
    if (plans.guard > 0 || plans.split.raster > 1) plan();
    if (!together && !centre.empty()) {
        plans.centreView = makeView(scene.camera, scene.info, viewRequest(config, {}, frame, plans.guard, keptGuard));
        plans.centre = planFrame(config, facts, plans.centreView, centre, frame);
    }
    return plans;
}

}  // namespace

ExplainedPlan planConfig(const RenderConfig& config, const LoadedScene& loaded, int frame, int maxTextureSize) {
    const DrawScene scene = resolveFrame(loaded, frameRequest(config, frame));
    const SceneFacts facts = sceneFacts(scene);
    FramePlans plans = planBoth(config, scene, facts, frame, maxTextureSize, 0);
    ExplainedPlan result{std::move(plans.averaged), std::move(plans.centre), {}};

    const auto& split = plans.split;
    std::size_t faces = 0;
    for (const auto& instance : scene.instances) faces += loaded.meshes[static_cast<std::size_t>(instance.mesh)].poly.faceCount();
    const auto fact = [&](std::string name, std::string value) { result.facts.emplace_back(std::move(name), std::move(value)); };
    fact("config", config.file.string());
    fact("scene", loaded.scene.file);
    fact("picture", fmt::format("{}×{} pixels, camera '{}'", config.image.size.x, config.image.size.y, scene.camera.name));
    fact("samples", fmt::format("{} per pixel: {} sub-frame{} on a raster {}× finer", split.samples(), split.subFrames, split.subFrames == 1 ? "" : "s", split.raster));
    if (plans.guard > 0) fact("guard band", fmt::format("{} pixels drawn around the picture", plans.guard));
    fact("accuracy", std::string(enumNames<Accuracy>[static_cast<std::size_t>(config.accuracy)]));
    fact("objects", fmt::format("{} instances, {} faces, {} lights", scene.instances.size(), faces, scene.lights.size()));
    fact("diagonal", fmt::format("{} scene units at frame {}", numberText(static_cast<float>(scene.info.diagonal())), loaded.scene.firstFrame()));
    const auto lengths = [&](const TechniqueChoice& choice) {
        const auto params = choice.at(frame);
        for (const auto& f : choice.technique->schema)
            if (&f.type() == &fieldType<Length>()) {
                const auto& length = *static_cast<const Length*>(f.member_(params.get()));
                if (length.relative) fact(std::string(f.name), fmt::format("{}% of the diagonal = {} scene units ({} '{}')", numberText(length.amount * 100), numberText(static_cast<float>(length.inSceneUnits(scene.info.diagonal()))), choice.technique->slot, choice.technique->name));
            }
    };
    for (std::size_t i = 0; i < loaded.meshes.size(); ++i) {
        auto options = subdivisionOf(loaded.scene.meshes[i], loaded.meshes[i].poly);
        if (!options || loaded.meshes[i].poly.faceCount() == 0) continue;
        fact("subdivision", fmt::format("'{}': {}", loaded.scene.meshes[i].name, describe(*options, loaded.scene.meshes[i].subdivision.edgeLength, planSubdivision(loaded.meshes[i].poly, *options))));
    }
    if (config.ao) lengths(*config.ao);
    for (const auto& layer : config.edges) lengths(layer);
    if (result.centre) fact("data AOVs", fmt::format("taken at pixel centres by one more sub-frame: {}", planSummary(*result.centre)));
    return result;
}

Renderer::Renderer(const gl::DeviceOptions& device, const std::filesystem::path& shaderFolder) : device_(device), shaders_(shaderFolder), executor_(device_, shaders_) {}

GpuScene& Renderer::sceneOnGpu(const RenderConfig& config, const LoadedScene& loaded, const DrawScene& scene, SceneData needs, std::vector<PartTime>& times) {
    const auto& materials = loaded.scene.materials;
    const bool changes = std::any_of(materials.begin(), materials.end(), [](const auto& material) { return material.moves(); });
    const bool fitted = std::any_of(loaded.scene.meshes.begin(), loaded.scene.meshes.end(), [](const auto& mesh) { return mesh.subdivision.wantedEdge().has_value(); });
    const std::string fittedTo = fitted ? fmt::format("{} {}x{}", config.camera, config.image.size.x, config.image.size.y) : "";
    std::vector<glm::dmat4> places;
    if (has(needs, SceneData::rays) || !scene.sections.empty())
        for (const auto& instance : scene.instances) places.push_back(instance.worldFromMesh);
    if (gpuScene_ && gpuSceneNumber_ == loaded.number && gpuSceneData_ == needs && gpuSceneFittedTo_ == fittedTo && !changes && places == places_ && scene.sections == sections_) return *gpuScene_;
    Stopwatch watch(times);
    // Edges that are cut to look smooth to the camera need a mesh per instance; else instances share theirs.
    struct Build { std::size_t mesh; std::optional<std::size_t> instance; };
    std::vector<Build> builds;
    std::vector<int> meshOf;
    std::vector<int> shared(loaded.meshes.size(), -1);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
        const bool own = loaded.scene.meshes[mesh].subdivision.wantedEdge().has_value();
        if (own || shared[mesh] < 0) {
            if (!own) shared[mesh] = static_cast<int>(builds.size());
            meshOf.push_back(static_cast<int>(builds.size()));
            builds.push_back({mesh, own ? std::optional(i) : std::nullopt});
        } else {
            meshOf.push_back(shared[mesh]);
        }
    }
    const MeshNeeds meshNeeds{has(needs, SceneData::normals), has(needs, SceneData::uvs), has(needs, SceneData::unifiedVertices)};
    std::vector<TriMesh> meshes(builds.size());
    tbb::parallel_for(std::size_t{0}, builds.size(), [&](std::size_t i) {
        const PolyMesh& poly = loaded.meshes[builds[i].mesh].poly;
        auto subdivision = subdivisionOf(loaded.scene.meshes[builds[i].mesh], poly);
        if (!subdivision) return void(meshes[i] = buildTriMesh(poly, meshNeeds));
        if (builds[i].instance) subdivision->edgeRate = edgeRates(loaded, *builds[i].instance, config);
        meshes[i] = subdivide(poly, *subdivision, meshNeeds, loaded.scene.meshes[builds[i].mesh].file);
    });
    watch.lap("of which triangles");
    if (!scene.sections.empty()) {
        cutOpen(loaded, scene, meshNeeds, meshes, meshOf);
        watch.lap("of which cutting");
    }
    gpuScene_ = nullptr;   // gives the old one's memory back first
    gpuScene_ = std::make_unique<GpuScene>(scene, meshes, meshOf, needs, device_.limits());
    watch.lap("of which upload");
    rayScene_ = nullptr;
    if (has(needs, SceneData::rays)) {
        rayScene_ = std::make_unique<RayScene>(scene, meshes, meshOf);
        watch.lap("of which ray tracing tree");
    }
    places_ = std::move(places);
    sections_ = scene.sections;
    gpuSceneNumber_ = loaded.number, gpuSceneData_ = needs, gpuSceneFittedTo_ = fittedTo;
    return *gpuScene_;
}

RenderedFrame Renderer::render(const RenderConfig& config, const LoadedScene& loaded, int frame, const RenderOptions& options) {
    RenderedFrame result;
    Stopwatch watch(result.times);
    const DrawScene scene = resolveFrame(loaded, frameRequest(config, frame));
    const SceneFacts facts = sceneFacts(scene);
    const int largest = std::min(device_.limits().maxTextureSize, device_.limits().maxViewport);
    const FramePlans plans = planBoth(config, scene, facts, frame, largest, options.guard);
    if (std::max(config.image.size.x, config.image.size.y) + 2 * plans.guard > largest)
        throw Error(ExitCode::usage, {config.file.string()}, fmt::format("{}×{} pixels are more than this GL device draws at once ({})", config.image.size.x, config.image.size.y, largest), "make image.size smaller");
    if (const auto layout = shadowLayout(scene.lights); std::max(layout.size.x, layout.size.y) > largest)
        throw Error(ExitCode::usage, {loaded.scene.file}, fmt::format("the shadow maps need a texture of {}×{}, more than this GL device allows ({})", layout.size.x, layout.size.y, largest), "lower shadow.resolution");
    watch.lap("plan");

    const SceneData needs = neededData(plans.averaged.plan, plans.centre);
    GpuScene& gpu = sceneOnGpu(config, loaded, scene, needs, result.times);
    watch.lap("scene to the GPU");
    executor_.prepare(plans.averaged.graph, plans.averaged.plan, plans.averagedView);
    watch.lap("programs");

    executor_.resetMeasurements();
    for (int sample = 0; sample < plans.split.samples(); ++sample) {
        ViewRequest request = viewRequest(config, plans.split, frame, plans.guard, options.guard);
        request.sample = sample;
        const View view = makeView(scene.camera, scene.info, request);
        gpu.setView(scene, view);
        const FramePlan one = planFrame(config, facts, view, plans.averaged.aovs, frame);
        executor_.run(one.graph, one.plan, view, gpu, rayScene_.get(), options.measure);
    }
    gl::finish();
    watch.lap("draw");
    passTimes_.clear();
    for (std::size_t i = 0; i < executor_.milliseconds().size(); ++i) {
        const Pass& pass = plans.averaged.graph.passes[static_cast<std::size_t>(plans.averaged.plan.passes[i].pass)];
        passTimes_.push_back({pass.name, pass.slot, executor_.milliseconds()[i]});
    }
    result.view = plans.averagedView;

    std::map<const Aov*, Image> images;
    const auto collect = [&](const FramePlan& plan) {
        for (std::size_t i = 0; i < plan.aovs.size(); ++i) {
            Image image = readBack(executor_.texture(plan.plan, plan.wanted[i].resource), *plan.aovs[i]);
            if (image.width != config.image.size.x && options.guard == 0) image = crop(image, {glm::ivec2(plans.guard), config.image.size});
            result.nonFinite += finish(image, *plan.aovs[i], plans.averagedView.unit);
            images[plan.aovs[i]] = options.crop.size.x > 0 ? crop(image, options.crop) : std::move(image);
        }
    };
    collect(plans.averaged);
    if (plans.centre) {
        executor_.resetMeasurements();
        gpu.setView(scene, plans.centreView);
        executor_.run(plans.centre->graph, plans.centre->plan, plans.centreView, gpu, rayScene_.get(), false);
        collect(*plans.centre);
    }
    watch.lap("read back");

    for (const Aov* aov : config.output.aovs) {
        Layer layer{std::string(aov->name), {}, aov->isColour, aov->isInteger(), std::move(images[aov])};
        for (int c = 0; c < aov->channelCount(); ++c) layer.channels.emplace_back(aov->channels[static_cast<std::size_t>(c)]);
        result.layers.push_back(std::move(layer));
    }
    const auto& device = device_.report();
    result.metadata = {{"Software", fmt::format("limn {}", kVersion)},
                       {"limn.config", config.hash},
                       {"limn.scene", loaded.hash},
                       {"limn.frame", std::to_string(frame)},
                       {"limn.accuracy", std::string(enumNames<Accuracy>[static_cast<std::size_t>(config.accuracy)])},
                       {"limn.device", fmt::format("{} | {}", device.renderer, device.version)},
                       {"limn.cpu", cpuFeatures()},
                       {"limn.plan", planSummary(plans.averaged)}};
    return result;
}

std::vector<std::filesystem::path> writeFrame(const RenderedFrame& frame, const std::filesystem::path& path, const EncodeOptions& options) {
    const auto format = fileFormat(path);
    if (!format) throw Error(ExitCode::usage, {path.string()}, "this is no picture file", "end the path in .png, .jpg, .tif or .exr");
    std::vector<std::filesystem::path> written;
    const auto write = [&](const std::filesystem::path& to, FileFormat as, std::span<const Layer> layers) {
        replaceFile(to, encodeImage(as, layers, frame.metadata, options));
        written.push_back(to);
    };
    if (isMultiLayer(*format)) {
        write(path, *format, frame.layers);
        return written;
    }
    const auto main = std::find_if(frame.layers.begin(), frame.layers.end(), [](const Layer& layer) { return layer.name == "beauty"; });
    for (auto layer = frame.layers.begin(); layer != frame.layers.end(); ++layer) {
        if (layer == main) {
            // An opaque picture needs no alpha channel.
            Layer picture = *layer;
            bool opaque = true;
            for (std::size_t i = 3; i < picture.image.pixels.size() && opaque; i += 4) opaque = picture.image.pixels[i] >= 1.0f - 1e-6f;
            if (opaque) {
                Image rgb{picture.image.width, picture.image.height, 3, {}};
                rgb.pixels.reserve(picture.image.pixels.size() / 4 * 3);
                for (std::size_t i = 0; i < picture.image.pixels.size(); i += 4) rgb.pixels.insert(rgb.pixels.end(), {picture.image.pixels[i], picture.image.pixels[i + 1], picture.image.pixels[i + 2]});
                picture.image = std::move(rgb);
            }
            write(path, *format, {&picture, 1});
            continue;
        }
        // Numbers that 8 bits would ruin stay numbers.
        const bool isData = !layer->isColour && layer->image.channels != 1;
        const bool exact = isData || layer->isInteger || layer->name == "depth";
        std::filesystem::path beside = path;
        beside.replace_extension("." + layer->name + (exact ? ".exr" : path.extension().string()));
        write(beside, exact ? FileFormat::exr : *format, {&*layer, 1});
    }
    return written;
}

bool hasFrameNumber(const std::filesystem::path& pattern) { return pattern.string().find('#') != std::string::npos; }

std::filesystem::path framePath(const std::filesystem::path& pattern, int frame) {
    std::string text = pattern.string();
    const auto first = text.find('#');
    if (first == std::string::npos) return pattern;
    auto last = first;
    while (last < text.size() && text[last] == '#') ++last;
    const std::string digits = fmt::format("{:0{}}", std::abs(frame), last - first);
    return text.replace(first, last - first, (frame < 0 ? "-" : "") + digits);
}

}  // namespace limn
