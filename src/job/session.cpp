#include "job/session.h"

#include <set>
#include <utility>

namespace limn {

Session::Session(SessionOptions options) : options_(std::move(options)) {}

Renderer& Session::renderer() {
    if (!renderer_) renderer_ = std::make_unique<Renderer>(options_.device, options_.shaderFolder);
    return *renderer_;
}

Session::Stamp Session::stampOf(const std::filesystem::path& file) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(file, failed);
    if (failed) return std::nullopt;
    const auto time = std::filesystem::last_write_time(file, failed);
    if (failed) return std::nullopt;
    return std::pair(size, time);
}

void Session::loadAhead(const RenderConfig& config) {
    auto& loading = scenes_[nameOf(config)];
    if (loading.valid()) return;
    begun_[nameOf(config)] = std::filesystem::file_time_type::clock::now();
    const auto load = [scene = config.scene, options = config.meshFile] {
        return std::make_shared<const LoadedScene>(loadScene(scene, options));
    };
    loading = std::async(std::launch::async, load).share();
}

void Session::makeAhead(const RenderConfig& config, std::optional<int> frame) {
    loadAhead(config);
    meshesFrame_ = frame;
    meshes_ = std::async(std::launch::async,
        [config, loading = scenes_.at(nameOf(config)), frame, held = renderer_ ? renderer_->held() : Renderer::Held()] {
            const LoadedScene& loaded = *loading.get();
            const int first = config.frames ? config.frames->first : loaded.scene.firstFrame();
            return makeMeshesOf(config, loaded, frame.value_or(first), held);
        });
}

const LoadedScene& Session::load(const RenderConfig& config) {
    loadAhead(config);
    const LoadedScene& loaded = *scenes_.at(nameOf(config)).get();
    auto& stamps = stamps_[nameOf(config)];
    for (const auto& files : {loaded.files, loaded.meshes->files()})
        for (const auto& file : files) {
            if (stamps.contains(file)) continue;
            const Stamp stamp = stampOf(file);
            // A file that was written while it may have been read counts as changed.
            // One from the future was written by a clock that runs ahead.
            const bool isSure = stamp
                && (stamp->second < begun_.at(nameOf(config))
                    || stamp->second > std::filesystem::file_time_type::clock::now());
            stamps.emplace(file, isSure ? stamp : std::nullopt);
        }
    return loaded;
}

void Session::forget(const RenderConfig& config) {
    scenes_.erase(nameOf(config));
    begun_.erase(nameOf(config));
    meshes_ = {};
    if (renderer_) renderer_->await({});
    stamps_.erase(nameOf(config));
}

void Session::forgetAll() {
    meshes_ = {};
    if (renderer_) renderer_->await({});
    scenes_.clear();
    begun_.clear();
    stamps_.clear();
}

void Session::forgetChanged() {
    if (!changedFiles().empty()) forgetAll();
}

std::map<std::filesystem::path, Session::Stamp> Session::files() const {
    std::map<std::filesystem::path, Stamp> all;
    for (const auto& [scene, stamps] : stamps_) all.insert(stamps.begin(), stamps.end());
    return all;
}

std::vector<std::filesystem::path> Session::changedFiles() const {
    std::set<std::filesystem::path> changed;
    for (const auto& [scene, stamps] : stamps_)
        for (const auto& [file, stamp] : stamps)
            if (!stamp || stampOf(file) != stamp) changed.insert(file);
    return {changed.begin(), changed.end()};
}

RenderedFrame Session::draw(const RenderConfig& config, int frame, const RenderOptions& options) {
    Renderer& drawing = renderer();
    const LoadedScene& loaded = load(config);
    if (meshes_.valid() && meshesFrame_.value_or(frame) == frame) drawing.await(std::move(meshes_));
    meshes_ = {};
    return drawing.render(config, loaded, frame, options);
}

FrameIdentity Session::identify(const RenderConfig& config, int frame, const PixelRect& crop) {
    Renderer& drawing = renderer();
    return drawing.identify(config, load(config), frame, crop);
}

ContentKey Session::pixelsKey(const RenderConfig& config, int frame) {
    return limn::pixelsKey(config, sceneAt(load(config), frameRequest(config, frame)), frame);
}

PlanReport Session::plan(const RenderConfig& config, int frame) {
    return reportPlan(config, load(config), frame, renderer_ ? renderer_->largestTexture() : kAnyTexture);
}

}  // namespace limn
