#include "effects/shading/lighting.h"

#include <algorithm>

namespace limn {

void readLighting(EffectBuilder& graph, Pass& pass, float aoStrength, Highlights highlights) {
    pass.reads.insert(pass.reads.end(), {{"depth", graph.read(aov::depth)}, {"normal", graph.read(aov::normal)}});
    if (highlights == Highlights::ofMaterials && !graph.scene().shiny) highlights = Highlights::none;
    if (highlights != Highlights::none) pass.defines.emplace_back("HIGHLIGHTS", "");
    if (highlights == Highlights::ofMaterials) {
        pass.reads.push_back({"materialId", graph.read(aov::materialId)});
        pass.defines.emplace_back("SHINY_MATERIALS", "");
        pass.needs = pass.needs | SceneData::materials;
    }
    if (const auto ao = graph.find(aov::ambientOcclusion); ao && aoStrength > 0) {
        pass.reads.push_back({"ambientOcclusion", *ao});
        pass.defines.emplace_back("WITH_AO", "");
    }
    const auto& lights = graph.scene().lights;
    if (const auto shadows = graph.shadowMaps()) {
        pass.reads.push_back({"shadowMaps", *shadows});
        pass.reads.push_back({"normalGeometric", graph.read(aov::normalGeometric)});
        pass.defines.emplace_back("WITH_SHADOWS", "");
        if (std::any_of(lights.begin(), lights.end(),
                [](const Light& l) { return l.shadow.present && l.kind == LightKind::point; }))
            pass.defines.emplace_back("POINT_SHADOWS", "");
    }
    const auto has = [&](LightKind kind) {
        return std::any_of(lights.begin(), lights.end(), [&](const Light& l) { return l.kind == kind; });
    };
    if (has(LightKind::point) || has(LightKind::spot)) pass.defines.emplace_back("PLACED_LIGHTS", "");
    if (has(LightKind::spot)) pass.defines.emplace_back("SPOTS", "");
    pass.defines.emplace_back("LIGHT_COUNT", std::to_string(lights.size()));
    pass.needs = pass.needs | SceneData::lights;
    pass.note = std::to_string(lights.size()) + (lights.size() == 1 ? " light" : " lights");
}

void addLitShading(
    EffectBuilder& graph, std::string name, UniformBlock params, float aoStrength, Highlights highlights) {
    const ResourceId result = graph.image(aov::shade);
    Pass pass;
    pass.name = std::move(name);
    readLighting(graph, pass, aoStrength, highlights);
    pass.reads.push_back({"albedo", graph.read(aov::albedo)});
    pass.writes = {{"result", result}};
    pass.params = std::move(params);
    graph.add(std::move(pass));
    graph.publish(aov::shade, result);
}

}  // namespace limn
