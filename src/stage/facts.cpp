#include "stage/facts.h"

#include <algorithm>
#include <bit>

namespace limn {

SceneFacts sceneFacts(const SceneAt& scene) {
    SceneFacts facts{scene.info, scene.lights, scene.instances, scene.materials};
    facts.lineRecords = scene.lineRecords.size() > 1;
    facts.sections = !scene.sections.empty();
    facts.marks = facts.sections
        || std::any_of(scene.instances.begin(), scene.instances.end(), [](const auto& one) { return one.hasLines; });
    facts.polygons = std::any_of(scene.instances.begin(), scene.instances.end(),
        [](const auto& one) { return one.mostTriangles > 1 && !one.isSubdivided; });
    facts.hatched = std::any_of(scene.materials.begin(), scene.materials.end(),
        [](const auto& material) { return material.hatch.spacing > 0; });
    for (const auto& instance : scene.instances)
        for (const auto number : instance.materials) {
            const Material& material = scene.materials[number];
            facts.textured = facts.textured || !material.texture.empty();
            facts.cutouts = facts.cutouts || !material.cutout.empty();
            facts.shiny = facts.shiny || (material.shininess > 1 && material.specular > 0);
            facts.vertexColors = facts.vertexColors || (instance.hasColors && material.vertexColors);
        }
    // Steps of four, so that few scenes need shaders of their own.
    std::uint64_t most = 1;
    for (const auto& instance : scene.instances) most = std::max(most, instance.mostTriangles);
    const int bits = 32 - (static_cast<int>(std::bit_width(scene.instances.size())) + 3) / 4 * 4;
    if (!facts.sections && bits > 0 && most <= std::uint64_t{1} << bits) facts.triangleBits = bits;
    for (const auto& light : scene.lights)
        facts.coloredLight = facts.coloredLight || light.color.r != light.color.g || light.color.g != light.color.b;
    return facts;
}

void addFacts(SceneFacts& facts, const SceneFacts& other) {
    constexpr bool SceneFacts::*kFacts[] = {&SceneFacts::textured, &SceneFacts::cutouts, &SceneFacts::vertexColors,
        &SceneFacts::shiny, &SceneFacts::coloredLight, &SceneFacts::lineRecords, &SceneFacts::polygons,
        &SceneFacts::sections, &SceneFacts::marks, &SceneFacts::hatched};
    for (const auto fact : kFacts) facts.*fact = facts.*fact || other.*fact;
    // A number for instance and triangle together serves only where all moments share out its bits alike.
    if (other.triangleBits != facts.triangleBits) facts.triangleBits = 0;
}

void pointAt(SceneFacts& facts, const SceneAt& scene) {
    facts.lights = scene.lights;
    facts.instances = scene.instances;
    facts.materials = scene.materials;
}

}  // namespace limn
