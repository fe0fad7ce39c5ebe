// The scene on the GPU: uploads only data that the plan reads, and only what has changed.
#pragma once

#include "gl/device.h"
#include "gl/objects.h"
#include "gpu/arena.h"
#include "gpu/atlas.h"
#include "gpu/coincident_faces.h"
#include "gpu/culling.h"
#include "graph/graph.h"
#include "picture/view.h"
#include "stage/scene_at.h"

#include <map>
#include <set>
#include <span>
#include <vector>

namespace limn {

class GpuScene {
public:
    /// `isSoftware`: large scenes may be culled to their visible triangles.
    GpuScene(const gl::Limits& limits, bool isSoftware);

    /// Declares the data to be read of the next scenes, and the number of their line records. A change drops all that
    /// is held.
    void require(SceneData needs, std::size_t lineRecords);
    std::set<ContentKey> residents() const;
    bool holds(const ContentKey& mesh) const { return residents_.contains(mesh); }

    /// Uploads the differences from the last scene. `meshOf`: the content key of each instance's mesh. Meshes that are
    /// not held must be in `made`, which may be released afterwards. Reads the textures' files when the plan needs
    /// them. Throws Error where the device cannot take the scene.
    void update(const SceneAt& scene, std::span<const ContentKey> meshOf, const std::map<ContentKey, TriMesh>& made);

    /// Recomputes the data that depends on the camera: instance transforms in double precision, lights.
    void setView(const SceneAt& scene, const View& view);

    /// Where the instances were seen a frame earlier, for SceneData::previous; `view` is that frame's.
    void setPrevious(const SceneAt& scene, const SceneAt& previous, const View& view);

    void bind() const;
    void draw() const;       ///< every instance, in scene order
    void drawAlone() const;  ///< the same, but for drawCoincident()

    /// Of all that the shadow maps of the last scene show.
    const ContentKey& shadowsKey() const { return shadowsKey_; }

    /// The lines that the last scene draws itself.
    std::span<const Mark> marks() const { return marks_; }

    /// Can drawSeen() cull the scene?
    bool isCullable() const { return isCullable_; }
    /// Draws the visible triangles in the last view's region: those that face the camera, or then, with `farthest`, the
    /// others (gpu/culling.h).
    void drawSeen(const FarthestDepths* farthest);
    /// Draws the faces that share a plane with others: drawAlone() and drawSeen() leave them out.
    void drawCoincident() const { coincident_.draw(inputs_); }

private:
    struct MeshPlace {
        std::uint32_t firstVertex, firstNormal, firstUv, firstTriangle, triangleCount, materialWords, partWords,
            colorWords;
        glm::dvec3 pivot;
    };
    struct Resident {
        MeshPlace place;
        ArenaPiece positions, triangles, normals, triangleNormals, uvs, triangleUvs;
        std::vector<ArenaPiece> words;
        std::vector<Cluster> clusters;
        std::vector<Segment> segments;
    };

    std::uint32_t putWords(Resident& resident, const std::vector<std::uint32_t>& values);
    void putMesh(const ContentKey& key, const TriMesh& mesh);
    void dropMesh(const Resident& resident);
    void putMeshes(std::span<const ContentKey> meshOf, const std::map<ContentKey, TriMesh>& made);
    /// Uploads the line records, and the materials of each instance.
    void putTables(const SceneAt& scene);
    void putMaterials(const SceneAt& scene);
    void putCommands();
    void putMarks(const SceneAt& scene);
    void putShadows(const SceneAt& scene, std::span<const ContentKey> meshOf);
    void putCoincident(const SceneAt& scene, std::span<const ContentKey> meshOf);
    /// Connects new buffers to shaders and vertex pipelines.
    void connect();
    void placeMeshes(const SceneAt& scene, const View& view);
    std::vector<std::byte> instanceBytes(const SceneAt& scene, const View& view) const;

    gl::Limits limits_;
    bool isSoftware_, isCullable_ = false;
    int aloneCount_ = 0;    ///< of aloneCommands_
    bool isReady_ = false;  ///< the last update succeeded: the held data is whole
    SceneData needs_ = SceneData::none;
    std::map<ContentKey, Resident> residents_;
    std::vector<const Resident*> shown_;  ///< of each instance
    Arena positions_, triangles_, normals_, triangleNormals_, uvs_, triangleUvs_, words_;
    ArenaPiece records_, tables_;                ///< of words_: line records at its begin, material tables
    std::vector<std::uint32_t> tableWords_;      ///< the content of both
    std::size_t recordWords_ = 0;                ///< the number of words that are line records
    std::vector<std::uint32_t> materialTables_;  ///< of each instance: where its table begins
    std::vector<int> generations_;               ///< of the arenas behind the views below
    gl::Buffer instances_, materials_, lights_, commands_, instanceNumbers_, previous_, aloneCommands_, shadowPlaces_;
    std::vector<std::byte> materialBytes_, commandBytes_, numberBytes_, aloneBytes_;
    gl::BufferView positionsView_, trianglesView_, normalsView_, uvsView_, triangleNormalsView_, triangleUvsView_,
        wordsView_, instancesView_, materialsView_, previousView_, shadowPlacesView_;
    TextureAtlas atlas_;
    gl::VertexArray vertexArray_;
    std::vector<gl::VertexInput> inputs_;

    CullView cullView_;
    std::vector<SeenPart> parts_;
    std::vector<Mark> marks_;
    ContentKey shadowsKey_;
    CoincidentFaces coincident_;
    ContentKey coincidentKey_;  ///< of the meshes and places that they were found among
};

}  // namespace limn
