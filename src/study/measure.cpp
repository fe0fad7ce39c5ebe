#include "study/measure.h"

#include "base/log.h"
#include "settings/color.h"
#include "study/shell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kSeeds = 8;                            // for the spread of an estimate
constexpr std::uint64_t kMostTriangles = 6'000'000;  // of geometry that counts as the limit

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n == 0 ? 0 : n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// Display-encoded red, green and blue over the background that the picture has.
std::vector<float> displayed(const Image& beauty) {
    std::vector<float> values;
    values.reserve(3 * beauty.pixels.size() / static_cast<std::size_t>(beauty.channels));
    for (std::size_t i = 0; i < beauty.pixels.size(); i += static_cast<std::size_t>(beauty.channels))
        for (std::size_t k = 0; k < 3; ++k)
            values.push_back(linearToSrgb(std::clamp(beauty.pixels[i + k], 0.0f, 1.0f)));
    return values;
}

/// Rec. 709 luma of display-encoded colours.
std::vector<float> luma(const std::vector<float>& rgb) {
    std::vector<float> values;
    for (std::size_t i = 0; i < rgb.size(); i += 3)
        values.push_back(0.2126f * rgb[i] + 0.7152f * rgb[i + 1] + 0.0722f * rgb[i + 2]);
    return values;
}

/// A difference as a colour: white where there is none, red where the picture is too dark, blue where it is too light;
/// full at a quarter of the range.
Image errorImage(const std::vector<float>& picture, const std::vector<float>& truth, glm::ivec2 size) {
    Image image{size.x, size.y, 3, {}};
    image.pixels.reserve(3 * picture.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const float off = truth[i] < 0 ? 0 : std::clamp(4 * (picture[i] - truth[i]), -1.0f, 1.0f);
        const glm::vec3 full = off < 0 ? glm::vec3(0.70f, 0.09f, 0.17f) : glm::vec3(0.13f, 0.40f, 0.67f);
        const glm::vec3 color = glm::mix(glm::vec3(1), full, std::abs(off));
        image.pixels.insert(image.pixels.end(), {color.r, color.g, color.b});
    }
    return image;
}

void addTo(Deviation& sum, const Deviation& one, double count) {
    sum.rmse = std::sqrt(sum.rmse * sum.rmse + one.rmse * one.rmse / count);
    sum.bias += one.bias / count;
    sum.p99 = std::max(sum.p99, one.p99);
}

double rmseOf(const std::vector<float>& picture, const std::vector<float>& truth,
    const std::vector<PixelClass>& classes, PixelClass wanted) {
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        if (classes[i] != wanted || truth[i] < 0) continue;
        const double d = static_cast<double>(picture[i]) - static_cast<double>(truth[i]);
        squares += d * d;
        ++count;
    }
    return count > 0 ? std::sqrt(squares / count) : 0;
}

/// Settings without those that a slot's new table replaces.
Settings with(Settings settings, const Settings& more) {
    for (const auto& [key, value] : more) {
        const std::string within = key + ".";
        std::erase_if(settings, [&](const auto& entry) { return entry.first.starts_with(within); });
        settings[key] = value;
    }
    return settings;
}

}  // namespace

Measurer::Measurer(Session& session, const StudyConfig& study, const SweepSettings& settings, std::vector<Shot> shots)
    : session_(session), study_(study), settings_(settings), shots_(std::move(shots)) {
    const Variant variant = study_.at({});
    hasOcclusion_ = study_.tracedOcclusion(1).has_value();
    const SceneAt scene = sceneAt(*variant.scene, frameRequest(variant.config, shots_.front().frame));
    hasCages_ =
        std::any_of(scene.instances.begin(), scene.instances.end(), [](const auto& i) { return i.isSubdivided; });
}

RenderedFrame Measurer::draw(const Variant& variant, const Shot& shot, std::vector<const Aov*> aovs, int guard) {
    RenderConfig config = variant.config;
    if (!shot.camera.empty()) config.camera = shot.camera;
    config.output.aovs = std::move(aovs);
    config.image.transparent = false;
    RenderOptions options;
    options.guard = guard;
    return session_.renderer().render(config, *variant.scene, shot.frame, options);
}

/// As many more levels as kMostTriangles allow, and shadows twice as sharp.
Settings Measurer::finest(Settings settings, const Shot& shot) const {
    const Variant variant = study_.at({});
    const SceneAt scene = sceneAt(*variant.scene, frameRequest(variant.config, shot.frame));
    std::uint64_t triangles = 0;
    for (const auto& instance : scene.instances) triangles += instance.mostTriangles;
    int more = 0;
    while (more < 2 && triangles << (2 * (more + 1)) <= kMostTriangles) ++more;
    if (hasCages_ && more > 0) settings["scene.subdivision.level"] = std::to_string(more);
    if (std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.shadow.present; }))
        settings["scene.shadow.resolution"] = "2";
    return settings;
}

void Measurer::findOcclusion(Truth& truth, const Shot& shot) {
    constexpr int kSamples = 32;  // of each half
    const int rays = std::max(1, settings_.rays / (2 * kSamples));
    const Settings base{{"accuracy", "\"exact\""}, {"image.samples", "1"}};
    const Variant plain = study_.at(base);
    const int guard = static_cast<int>(std::ceil(
                          plain.config.image.guard * std::max(plain.config.image.size.x, plain.config.image.size.y)))
        / 2 * 2;
    const std::vector<const Aov*> surfaces{&aov::depth, &aov::normalGeometric};
    const RenderedFrame seen = draw(plain, shot, surfaces);
    truth.classes = classifyPixels(seen);
    Settings traced = with(base, *study_.tracedOcclusion(rays));
    traced["image.samples"] = traced["image.ao_samples"] = std::to_string(kSamples);
    traced["image.seed"] = Halves::kSeeds[0];
    const Variant variant = study_.at(traced);
    traced["image.seed"] = Halves::kSeeds[1];
    truth.occlusion = draw(variant, shot, {&aov::ambientOcclusion}).layers[0].image.pixels;
    const auto other = draw(study_.at(traced), shot, {&aov::ambientOcclusion}).layers[0].image.pixels;
    Halves halves;
    halves.join(truth.occlusion, other, seen.layers[0].image.pixels);
    truthError_ = std::max(truthError_, halves.standardError());

    const Field* radius = findField(variant.config.in("ao").front().technique->schema, "radius");
    const Length length =
        *static_cast<const Length*>(radius->constMember(variant.config.in("ao").front().params.get()));
    truth.shell = shellVisibility(
        draw(plain, shot, surfaces, guard), sceneInfo(*plain.scene), length, settings_.rays, plain.config.image.size);
    for (std::size_t i = 0; i < truth.shell.size(); ++i)
        if (truth.occlusion[i] < 0) truth.shell[i] = -1;
}

const Measurer::Truth& Measurer::truth(std::size_t number) {
    if (const auto it = truths_.find(number); it != truths_.end()) return it->second;
    const Shot& shot = shots_[number];
    Truth& truth = truths_[number];
    log::info("the truth: {} samples of the picture{}", settings_.samples,
        hasOcclusion_ ? fmt::format(", {} rays per pixel", settings_.rays) : "");
    if (hasOcclusion_) findOcclusion(truth, shot);
    Settings converged{{"accuracy", "\"exact\""}, {"image.samples", std::to_string(settings_.samples)},
        {"image.line_samples", std::to_string(settings_.samples)}};
    // Ambient occlusion is smooth: many rays in few samples.
    constexpr int kOcclusionSamples = 4;
    if (hasOcclusion_) converged = with(converged, *study_.tracedOcclusion(settings_.rays / kOcclusionSamples));
    converged["image.ao_samples"] = std::to_string(hasOcclusion_ ? kOcclusionSamples : settings_.samples);
    const Variant variant = study_.at(finest(converged, shot));
    truth.picture = displayed(draw(variant, shot, {&aov::beauty}).layers[0].image);
    if (hasCages_)
        truth.surface = draw(study_.at(finest({{"accuracy", "\"exact\""}, {"image.samples", "1"}}, shot)), shot,
            {&aov::depth, &aov::normalGeometric});
    return truth;
}

std::pair<Image, Image> Measurer::truePictures() {
    const Truth& known = truth(0);
    const glm::ivec2 size = study_.at({}).config.image.size;
    std::pair<Image, Image> pictures{{size.x, size.y, 3, known.picture}, {}};
    if (hasOcclusion_) pictures.second = {size.x, size.y, 1, known.occlusion};
    for (float& value : pictures.second.pixels) value = value < 0 ? 1 : value;
    return pictures;
}

void Measurer::time(const Variant& variant, StudyPoint& point) {
    const auto count = static_cast<double>(shots_.size());
    RenderOptions options;
    options.measure = true;
    std::map<std::string, double> slots;
    for (const Shot& shot : shots_) {
        RenderConfig config = variant.config;
        if (!shot.camera.empty()) config.camera = shot.camera;
        config.image.transparent = false;
        std::vector<double> times;
        std::map<std::string, std::vector<double>> ofSlots;
        for (int run = 0; run <= settings_.repeat; ++run) {
            const auto begin = std::chrono::steady_clock::now();
            session_.renderer().render(config, *variant.scene, shot.frame, options);
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
            if (run == 0) {  // compiles, uploads, draws shadow maps, and warms up
                point.first = std::max(point.first, took.count());
                continue;
            }
            times.push_back(took.count());
            std::map<std::string, double> sums;
            for (const auto& pass : session_.renderer().passTimes()) sums[pass.slot] += pass.milliseconds;
            for (const auto& [slot, milliseconds] : sums) ofSlots[slot].push_back(milliseconds);
        }
        std::sort(times.begin(), times.end());
        point.milliseconds += median(times) / count;
        point.low += times[times.size() / 4] / count;
        point.high += times[times.size() - 1 - times.size() / 4] / count;
        for (const auto& [slot, all] : ofSlots) slots[slot] += median(all) / count;
    }
    point.runs = settings_.repeat;
    point.slots.assign(slots.begin(), slots.end());
}

void Measurer::tryDrawing(const Settings& settings) { draw(study_.at(settings), shots_.front(), {&aov::beauty}); }

GeometryError Measurer::geometryError(const RenderedFrame& seen, const RenderedFrame& finest) const {
    std::vector<double> off;
    double squares = 0;
    const Image &depth = seen.layers[0].image, &truth = finest.layers[0].image, &normals = finest.layers[1].image;
    const View& view = finest.view;
    for (int y = 0; y < truth.height; ++y)
        for (int x = 0; x < truth.width; ++x) {
            const double a = static_cast<double>(*depth.at(x, y)), b = static_cast<double>(*truth.at(x, y));
            if (!std::isfinite(a) || !std::isfinite(b)) continue;
            const float* n = normals.at(x, y);
            // Along the normal: depths differ a lot where a surface is seen at a slant.
            const glm::dvec3 along = view.orthographic ? glm::dvec3(0, 0, -1) : placeOf(view, x, y, 1);
            const double cosine = std::abs(glm::dot(along, glm::dvec3(n[0], n[1], n[2])));
            const double footprint = view.rayScale.x * (view.orthographic ? 1 : b * view.unit);
            const double pixels = std::abs(a - b) * view.unit * cosine / footprint;
            // Beyond a few pixels the two show different surfaces: an outline moved, which the picture's error counts.
            if (pixels > 8) continue;
            squares += pixels * pixels;
            off.push_back(pixels);
        }
    if (off.empty()) return {};
    return {std::sqrt(squares / static_cast<double>(off.size())), percentile99(std::move(off))};
}

StudyPoint Measurer::measure(const Settings& settings, PointPictures& pictures) {
    const Variant variant = study_.at(settings);
    StudyPoint point;
    point.settings = settings;
    point.lines = study_.lines(settings);
    for (std::size_t s = 0; s < shots_.size(); ++s) truth(s);
    time(variant, point);
    const auto count = static_cast<double>(shots_.size());
    const bool drawsOcclusion = hasOcclusion_ && !variant.config.in("ao").empty();
    point.similarity = 0;
    for (std::size_t s = 0; s < shots_.size(); ++s) {
        const Truth& known = truth(s);
        std::vector<const Aov*> aovs{&aov::beauty};
        if (drawsOcclusion) aovs.push_back(&aov::ambientOcclusion);
        RenderedFrame frame = draw(variant, shots_[s], aovs);
        const glm::ivec2 size(frame.layers[0].image.width, frame.layers[0].image.height);
        const auto picture = displayed(frame.layers[0].image);
        const auto gray = luma(picture), trueGray = luma(known.picture);
        addTo(point.picture, compare(picture, known.picture), count);
        point.similarity += similarity(gray, trueGray, size) / count;
        if (drawsOcclusion) {
            const auto& seen = frame.layers[1].image.pixels;
            if (!point.occlusion) point.occlusion.emplace();
            addTo(*point.occlusion, compare(seen, known.occlusion), count);
            const auto add = [&](double& sum, PixelClass which) {
                const double one = rmseOf(seen, known.occlusion, known.classes, which);
                sum = std::sqrt(sum * sum + one * one / count);
            };
            add(point.occlusion->inside, PixelClass::inside);
            add(point.occlusion->silhouette, PixelClass::silhouette);
            add(point.occlusion->border, PixelClass::border);
        }
        if (hasCages_) {
            Variant once = variant;
            once.config.image.samples = 1;
            const GeometryError one = geometryError(draw(once, shots_[s], {&aov::depth}), known.surface);
            if (!point.geometry) point.geometry.emplace();
            point.geometry->rmse = std::sqrt(std::pow(point.geometry->rmse, 2) + one.rmse * one.rmse / count);
            point.geometry->p99 = std::max(point.geometry->p99, one.p99);
        }
        if (s > 0) continue;
        pictures.beautyError = errorImage(gray, trueGray, size);
        pictures.beauty = std::move(frame.layers[0].image);
        if (!drawsOcclusion) continue;
        pictures.occlusionError = errorImage(frame.layers[1].image.pixels, known.occlusion, size);
        pictures.occlusion = std::move(frame.layers[1].image);
    }
    return point;
}

ErrorSplit Measurer::split(const Settings& settings) {
    // What rays see is not bounded by the depth buffer.
    const bool isTraced = study_.at(settings).config.in("ao").front().technique == findTechnique("ao", "ray_traced");
    const auto count = static_cast<double>(shots_.size());
    double unseen = 0, estimator = 0, sampling = 0;
    for (std::size_t s = 0; s < shots_.size(); ++s) {
        const Truth& known = truth(s);
        std::vector<double> sum(known.occlusion.size()), squares(known.occlusion.size());
        for (int seed = 0; seed < kSeeds; ++seed) {
            Settings seeded = settings;
            seeded["image.seed"] = std::to_string(1000 + seed);
            const RenderedFrame frame = draw(study_.at(seeded), shots_[s], {&aov::ambientOcclusion});
            for (std::size_t i = 0; i < sum.size(); ++i) {
                const auto value = static_cast<double>(frame.layers[0].image.pixels[i]);
                sum[i] += value;
                squares[i] += value * value;
            }
        }
        double n = 0, ofShell = 0, ofMean = 0, ofChance = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            if (known.occlusion[i] < 0) continue;
            const double mean = sum[i] / kSeeds;
            const auto shell = static_cast<double>(isTraced ? known.occlusion[i] : known.shell[i]);
            const double variance = std::max(0.0, (squares[i] - kSeeds * mean * mean) / (kSeeds - 1));
            ofShell += std::pow(shell - static_cast<double>(known.occlusion[i]), 2);
            ofMean += std::pow(mean - shell, 2) - variance / kSeeds;  // the mean's own chance
            ofChance += variance;
            ++n;
        }
        n = std::max(n, 1.0);
        unseen += ofShell / n / count;
        estimator += std::max(0.0, ofMean) / n / count;
        sampling += ofChance / n / count;
    }
    return {std::sqrt(unseen), std::sqrt(estimator), std::sqrt(sampling)};
}

}  // namespace limn
