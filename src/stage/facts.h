// Facts about a scene at a frame, for effects.
#pragma once

#include "stage/scene_at.h"

#include <span>

namespace limn {

/// Facts about the scene at a frame that an effect may build on.
struct SceneFacts {
    SceneInfo info;
    std::span<const Light> lights;
    std::span<const DrawInstance> instances;
    std::span<const Material> materials;
    bool textured = false;      ///< some drawn material has a texture
    bool cutouts = false;       ///< some drawn material has holes
    bool vertexColors = false;  ///< some drawn mesh has vertex colours, and a material that wants them
    bool shiny = false;         ///< some drawn material has a highlight
    bool coloredLight = false;  ///< some light is not grey
    bool lineRecords = false;   ///< some object or material says something about its lines
    bool polygons = false;      ///< some drawn mesh is not subdivided: faces may lie in one plane
    bool sections = false;      ///< something is cut open
    bool marks = false;         ///< some mesh draws lines of its own, or may leave some where it is cut open
    bool hatched = false;       ///< and its cut faces are hatched
    int triangleBits = 0;       ///< bits of a triangle's number, beside its instance's in 32 bits; 0 if both do not fit
};

SceneFacts sceneFacts(const SceneAt& scene);

/// Makes facts hold for another moment of the same frame too.
void addFacts(SceneFacts& facts, const SceneFacts& other);
/// Lets the facts' lists be those of a scene at another moment, which the facts hold for.
void pointAt(SceneFacts& facts, const SceneAt& scene);

}  // namespace limn
