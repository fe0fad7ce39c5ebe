// What changes from frame to frame: the report of `limn plan --frames`.

#include "base/text.h"
#include "render/identity.h"
#include "render/report.h"
#include "stage/meshes.h"
#include "stage/shadow_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace limn {
namespace {

/// A frame, as far as frames are compared.
struct State {
    SceneAt scene;
    ContentKey pixels;
    std::vector<std::string> settings;  ///< of all techniques, as text
    std::set<ContentKey> meshes;        ///< made for it
    ContentKey shadows;                 ///< of its shadow maps
    int shadowMaps = 0;
};

State stateAt(const RenderConfig& config, const LoadedScene& loaded, int frame) {
    State state;
    const FrameRequest request = frameRequest(config, frame);
    state.scene = sceneAt(loaded, request);
    state.pixels = pixelsKey(config, state.scene, frame);
    for (const auto& [slot, choices] : config.choices)
        for (const auto& choice : choices) {
            const auto settings = choice.at(frame);
            for (const Field& field : choice.technique->schema)
                state.settings.push_back(
                    fmt::format("{} = {}", field.name, field.type().text(field.constMember(settings.get()))));
        }
    const MeshOrders orders = orderMeshes(loaded, state.scene, request, {});
    for (const auto& order : orders.orders) state.meshes.insert(order.key);
    std::vector<ContentKey> meshOf;
    for (const std::size_t order : orders.orderOf) meshOf.push_back(orders.orders[order].key);
    state.shadows = shadowsKey(state.scene, meshOf);
    const PixelRect block{glm::ivec2(0), largestBlock(config.image.size)};
    const TilePipelines pipelines =
        buildPipelines(config, state.scene, sceneFacts(state.scene), frame, kAnyTexture, 0, {block, block});
    if (has(pipelines.sceneData(), SceneData::shadows))
        state.shadowMaps = static_cast<int>(shadowLayout(state.scene.lights).maps.size());
    return state;
}

template <class T>
std::size_t countUnlike(const std::vector<T>& a, const std::vector<T>& b) {
    std::size_t count = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] != b[i] ? 1 : 0;
    return count;
}

bool isSameCamera(const Camera& a, const Camera& b) {
    return a.position == b.position && a.lookAt == b.lookAt && a.up == b.up && a.focalLength == b.focalLength
        && a.sensorWidth == b.sensorWidth && a.fov == b.fov && a.orthographicHeight == b.orthographicHeight
        && a.shift == b.shift && a.near == b.near && a.far == b.far;
}

std::vector<std::string> reasonsOf(const RenderConfig& config, const State& before, const State& now) {
    std::vector<std::string> reasons;
    const auto count = [&](std::size_t some, std::size_t all, std::string_view what, std::string_view does) {
        if (some > 0) reasons.push_back(fmt::format("{} of {} {} {}", some, all, what, does));
    };
    if (!isSameCamera(before.scene.camera, now.scene.camera)) reasons.emplace_back("the camera moves");
    std::map<std::size_t, const DrawInstance*> known;
    for (const auto& instance : before.scene.instances) known[instance.source] = &instance;
    std::size_t moving = 0, appearing = 0;
    for (const auto& instance : now.scene.instances) {
        const auto it = known.find(instance.source);
        appearing += it == known.end() ? 1 : 0;
        moving += it != known.end() && it->second->worldFromMesh != instance.worldFromMesh ? 1 : 0;
        if (it != known.end()) known.erase(it);
    }
    const std::size_t all = now.scene.instances.size();
    count(moving, all, "objects", "move");
    count(appearing, all, "objects", "appear");
    if (!known.empty()) reasons.push_back(fmt::format("{} objects vanish", known.size()));
    count(countUnlike(before.scene.materialKeys, now.scene.materialKeys), now.scene.materials.size(), "materials",
        "change");
    count(countUnlike(before.scene.lightKeys, now.scene.lightKeys), now.scene.lights.size(), "lights", "change");
    for (std::size_t i = 0; i < now.settings.size(); ++i)
        if (i >= before.settings.size() || before.settings[i] != now.settings[i]) reasons.push_back(now.settings[i]);
    if (config.image.seedIsFrame) reasons.emplace_back("the seed is the frame's");
    if (config.image.shutter > 0) reasons.emplace_back("the shutter is open between frames");
    return reasons;
}

}  // namespace

std::vector<FrameChange> compareFrames(
    const RenderConfig& config, const LoadedScene& loaded, std::span<const int> frames) {
    std::vector<FrameChange> changes;
    State before;
    for (const int frame : frames) {
        State now = stateAt(config, loaded, frame);
        FrameChange& change = changes.emplace_back();
        change.frame = frame;
        for (std::size_t m = 0; m < now.scene.meshes.size(); ++m) {
            const auto& mesh = now.scene.meshes[m];
            if (!mesh || (changes.size() > 1 && before.scene.meshes[m] && before.scene.meshes[m]->key == mesh->key))
                continue;
            change.files.push_back(mesh->files.front().string());
        }
        for (const auto& mesh : now.meshes) change.meshesMade += before.meshes.contains(mesh) ? 0 : 1;
        if (changes.size() == 1 || before.shadows != now.shadows) change.shadowMaps = now.shadowMaps;
        if (changes.size() == 1) {
            change.reasons.emplace_back("first frame");
        } else {
            change.isSame = config.image.shutter == 0 && now.pixels == before.pixels;
            if (!change.isSame) change.reasons = reasonsOf(config, before, now);
        }
        before = std::move(now);
    }
    return changes;
}

std::string frameChangesText(const std::vector<FrameChange>& changes) {
    std::string text =
        fmt::format("{:>7}  {:<6} {:>5} {:>7} {:>8}  {}\n", "frame", "drawn", "read", "meshes", "shadows", "because");
    for (const auto& change : changes) {
        std::vector<std::string> reasons = change.reasons;
        if (changes.front().frame != change.frame && !change.files.empty())
            reasons.push_back(fmt::format("{}{} read", change.files.front(),
                change.files.size() > 1 ? fmt::format(" and {} more", change.files.size() - 1) : ""));
        text += fmt::format("{:>7}  {:<6} {:>5} {:>7} {:>8}  {}\n", change.frame, change.isSame ? "no" : "yes",
            change.files.size(), change.meshesMade, change.shadowMaps,
            change.isSame ? "shows what the last one shows: its pixels are written again"
                          : fmt::format("{}", fmt::join(reasons, ", ")));
    }
    return text;
}

std::string frameChangesJson(const std::vector<FrameChange>& changes) {
    const auto list = [](const std::vector<std::string>& texts) {
        std::vector<std::string> quoted;
        quoted.reserve(texts.size());
        for (const auto& one : texts) quoted.push_back(jsonText(one));
        return fmt::format("[{}]", fmt::join(quoted, ", "));
    };
    std::string text;
    for (const auto& change : changes)
        text += fmt::format(
            "{} {{\"frame\": {}, \"drawn\": {}, \"reasons\": {}, \"files_read\": {}, \"meshes_made\": {}, "
            "\"shadow_maps\": {}}}",
            text.empty() ? "" : ",\n", change.frame, !change.isSame, list(change.reasons), list(change.files),
            change.meshesMade, change.shadowMaps);
    return "{\"frames\": [\n" + text + "\n]}\n";
}

}  // namespace limn
