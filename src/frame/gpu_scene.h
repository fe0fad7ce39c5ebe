// The scene as the GPU sees it: only the data that the plan reads is uploaded.
#pragma once

#include "frame/culling.h"
#include "frame/view.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "graph/graph.h"
#include "image/image.h"
#include "scene/scene.h"

#include <span>
#include <string_view>

namespace limn {

/// One mesh, placed.
struct DrawInstance {
    int mesh = 0;
    glm::dmat4 worldFromMesh{1};
    std::vector<std::uint32_t> materials;    ///< of each of the mesh's material names: index into DrawScene::materials
    std::uint32_t firstObject = 1;           ///< object_id of the mesh's first part
    std::string_view name;                   ///< of the instance in the scene; as long as that lives, like:
    std::span<const std::string> parts;      ///< names of the mesh's parts
    std::vector<std::uint32_t> lineRecords;  ///< beside materials: index into DrawScene::lineRecords
    bool hasColors = false;                  ///< the mesh has vertex colours
    std::uint64_t mostTriangles = 0;         ///< that may be made of the mesh, sections aside
};

/// A plane that cuts the scene open. Beyond it, on its normal's side, nothing is drawn.
struct SectionPlane {
    glm::dvec3 point{0}, normal{0, 0, 1};
    bool operator==(const SectionPlane&) const = default;
};

/// The scene at one frame, with everything resolved.
struct DrawScene {
    std::vector<DrawInstance> instances;
    std::vector<Material> materials;
    std::vector<LineOverride> lineRecords{LineOverride()};  ///< the first says nothing
    std::vector<Light> lights;
    std::vector<SectionPlane>
        sections;  ///< cut faces have as material the instance's mesh's materials, then one per section
    Camera camera;
    SceneInfo info;
};

/// The one texture that holds every shadow map, and the square of each: one for a sun or spot, six for a point light.
/// The number of a drawing is 8 · light + face. Empty when no light casts a shadow.
struct ShadowLayout {
    glm::ivec2 size{0};
    std::vector<Drawing> drawings;
};
ShadowLayout shadowLayout(std::span<const Light> lights);

class GpuScene {
public:
    /// `meshes` may be released afterwards. Reads the textures' files when the plan needs them. `cullable`: of scenes
    /// with many triangles, only what can be seen need be drawn.
    GpuScene(const DrawScene& scene, std::span<const TriMesh> meshes, std::span<const int> meshOf, SceneData needs,
        const gl::Limits& limits, bool cullable);

    /// Recomputes what depends on the camera: instance transforms in double precision, lights.
    void setView(const DrawScene& scene, const View& view);

    void bind() const;
    void draw() const;  ///< every instance, in scene order

    /// Can parts be drawn?
    bool isCullable() const { return !clusters_.empty(); }
    /// What can be seen in the last view's region: triangles that face the camera, or after that, with `farthest`,
    /// those that do not (frame/culling.h).
    void drawSeen(const FarthestDepths* farthest);

private:
    void loadTextures(const DrawScene& scene, int maxTextureSize);
    void placeMeshes(const DrawScene& scene, const View& view);
    std::vector<std::byte> instanceBytes(const DrawScene& scene, const View& view) const;
    std::vector<std::byte> lightBytes(const DrawScene& scene, const View& view) const;

    struct MeshPlace {
        std::uint32_t firstVertex, firstNormal, firstUv, firstTriangle, triangleCount, materialWords, partWords,
            colorWords;
        glm::dvec3 pivot;
    };
    std::vector<MeshPlace> places_;
    std::vector<std::uint32_t> materialTables_;  ///< offset of each instance's table in the words buffer
    struct AtlasEntry {
        glm::ivec3 place{0};
        int levels = 0;
        glm::ivec2 size{0};
    };                                      ///< place: x, y, layer
    std::vector<AtlasEntry> atlasEntries_;  ///< of each material
    SceneData needs_;
    std::vector<int> meshOf_;  ///< of each instance: index into places_
    gl::Buffer positions_, normals_, uvs_, indices_, normalIndices_, uvIndices_, words_, instances_, materials_,
        lights_, commands_, instanceNumbers_;
    gl::BufferView positionsView_, trianglesView_, normalsView_, uvsView_, triangleNormalsView_, triangleUvsView_,
        wordsView_, instancesView_, materialsView_;
    gl::Texture atlas_;
    gl::VertexArray vertexArray_;

    std::vector<std::vector<Cluster>> clusters_;  ///< of each mesh
    CullView cullView_;
    std::vector<SeenPart> parts_;
    std::vector<gl::VertexInput> inputs_;
};

}  // namespace limn
