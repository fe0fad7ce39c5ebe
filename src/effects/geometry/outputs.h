// The promises of every geometry technique: the AOVs of the visible surfaces. The plan keeps only those that are read.
#pragma once

#include "effects/technique.h"

namespace limn {

inline std::vector<Write> publishSurfaces(EffectBuilder& graph) {
    const SceneData textures = (graph.scene().textured ? SceneData::textures | SceneData::uvs : SceneData::none)
        | (graph.scene().vertexColors ? SceneData::colors : SceneData::none);
    const std::pair<const Aov*, SceneData> outputs[] = {
        {&aov::depth, SceneData::none},
        {&aov::normal, SceneData::normals},
        {&aov::normalGeometric, SceneData::none},
        {&aov::position, SceneData::none},
        {&aov::albedo, SceneData::materials | textures},
        {&aov::objectId, SceneData::none},
        {&aov::materialId, SceneData::materials},
        {&aov::lineRecord, SceneData::materials},
    };
    std::vector<Write> writes;
    for (const auto& [aov, needs] : outputs) {
        const ResourceId image = graph.image(*aov);
        // Directions: NO_NORMAL of shaders/lib/normals.glsl.
        const glm::vec4 clear = aov == &aov::depth ? glm::vec4(kBackgroundDepth)
            : aov->kind == AovKind::direction      ? glm::vec4(2, 0, 0, 0)
                                                   : glm::vec4(0);
        writes.push_back({std::string(aov->name), image, needs, clear});
        graph.publish(*aov, image);
    }
    return writes;
}

inline std::vector<std::pair<std::string, std::string>> surfaceDefines(const EffectBuilder& graph) {
    std::vector<std::pair<std::string, std::string>> defines;
    if (graph.scene().textured) defines.emplace_back("TEXTURED", "");
    if (graph.scene().vertexColors) defines.emplace_back("VERTEX_COLORS", "");
    if (graph.scene().hatched) defines.emplace_back("HATCHED", "");
    return defines;
}

}  // namespace limn
