#include "render/identity.h"

#include "base/file.h"
#include "base/install.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

/// CPU features on which llvmpipe's code depends, and the last bits of its results.
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

void addCamera(KeyBuilder& key, const Camera& camera) {
    for (const auto& v : {camera.position, camera.lookAt, camera.up}) key.add(v.x).add(v.y).add(v.z);
    for (const double value : {camera.focalLength, camera.sensorWidth, camera.fov, camera.orthographicHeight,
             camera.shift.x, camera.shift.y, camera.near, camera.far})
        key.add(value);
}

void addInstance(KeyBuilder& key, const DrawInstance& instance) {
    key.add(instance.mesh).bytes(&instance.worldFromMesh, sizeof instance.worldFromMesh);
    key.add(instance.materials).add(instance.lineRecords).add(instance.firstObject).add(instance.name);
}

/// Everything that is drawn, by content.
void addScene(KeyBuilder& key, const SceneAt& scene) {
    for (const auto& mesh : scene.meshes)
        if (mesh) key.add(mesh->key.low).add(mesh->key.high);
    for (const auto& instance : scene.instances) addInstance(key, instance);
    for (const auto& keys : {scene.materialKeys, scene.lightKeys})
        for (const auto& one : keys) key.add(one.low).add(one.high);
    for (const auto& material : scene.materials) {
        const Hatch& hatch = material.hatch;
        key.add(material.isCut).add(hatch.spacing).add(hatch.width).add(hatch.angle);
        key.add(hatch.color.r).add(hatch.color.g).add(hatch.color.b);
    }
    for (const auto& record : scene.lineRecords)
        for (const auto word : lineRecordWords(record)) key.add(word);
    for (const auto& section : scene.sections) key.bytes(&section, sizeof section);
    addCamera(key, scene.camera);
    const auto& [lo, hi] = scene.info.bounds;
    for (const auto& v : {lo, hi, scene.info.up}) key.add(v.x).add(v.y).add(v.z);
}

}  // namespace

Metadata metadataOf(const RenderConfig& config, const SceneAt& scene, int frame, const PixelRect& crop,
    const gl::DeviceReport& device, const std::string& shaders, const Pipeline& pipeline) {
    Metadata all{{"Software", fmt::format("limn {}", kVersion)}, {"limn.config", config.hash},
        {"limn.scene", scene.key.hex()}, {"limn.frame", std::to_string(frame)},
        {"limn.accuracy", std::string(config.in("geometry").front().technique->name)},
        {"limn.device", fmt::format("{} | {}", device.renderer, device.version)}, {"limn.cpu", cpuFeatures()},
        {"limn.plan", passNames(pipeline)}};
    if (!config.promise.empty()) all.emplace_back("limn.quality", config.promise);
    if (crop.size.x > 0)
        all.emplace_back(
            "limn.crop", fmt::format("{},{},{},{}", crop.origin.x, crop.origin.y, crop.size.x, crop.size.y));
    if (!shaders.empty()) all.emplace_back("limn.shaders", shaders);
    return all;
}

ContentKey pixelsKey(const RenderConfig& config, const SceneAt& scene, int frame) {
    KeyBuilder key;
    key.add(config.hash);
    // What else depends on the frame's number, or on the frame before.
    const auto& aovs = config.output.aovs;
    if (config.image.seedIsFrame || std::find(aovs.begin(), aovs.end(), &aov::motion) != aovs.end()) key.add(frame);
    for (const auto& [slot, choices] : config.choices)
        for (const auto& choice : choices) {
            const auto settings = choice.at(frame);
            for (const Field& field : choice.technique->schema)
                key.add(field.type().text(field.constMember(settings.get())));
        }
    addScene(key, scene);
    return key.key();
}

std::string shadersKey(const std::filesystem::path& folder) {
    if (folder.empty()) return {};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    KeyBuilder key;
    for (const auto& file : files) key.add(file.lexically_relative(folder).string()).add(readFile(file));
    return key.key().hex();
}

}  // namespace limn
