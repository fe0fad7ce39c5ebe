// The scene's triangles as one camera sees them, in double precision: the input of everything in this room.
#pragma once

#include "drawing/edge_table.h"
#include "graph/graph.h"
#include "picture/view.h"
#include "rays/holes.h"
#include "stage/scene_at.h"

#include <array>
#include <span>
#include <vector>

namespace limn {

/// The camera's rays without the sample's place: lines are the same in every sample.
struct Projector {
    explicit Projector(const View& view);

    bool isParallel = false;
    glm::dvec2 rayScale{1}, rayOffset{0};  ///< as View's, for pixels' lower left corners
    double nearest = 0;                    ///< depth from which points can be seen; normalized units

    /// Place in the whole picture, in pixels from its lower left; of points before the eye.
    glm::dvec2 place(const glm::dvec3& p) const {
        return ((isParallel ? glm::dvec2(p) : glm::dvec2(p) / -p.z) - rayOffset) / rayScale;
    }
    /// Above 0 where a surface with this normal at p faces the eye.
    double facing(const glm::dvec3& normal, const glm::dvec3& p) const {
        return isParallel ? normal.z : -glm::dot(normal, p);
    }
    /// Is x seen at the left (above 0) or at the right of the way from p to q? Linear in x.
    double side(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& x) const {
        if (!isParallel) return glm::dot(glm::cross(q, p), x);
        return (q.x - p.x) * (x.y - p.y) - (q.y - p.y) * (x.x - p.x);
    }
};

/// A mesh where an instance shows it.
struct ViewedMesh {
    const TriMesh* mesh = nullptr;
    const TriangleEdges* edges = nullptr;
    const DrawInstance* instance = nullptr;
    std::uint32_t firstVertex = 0;     ///< number of its first position among all
    std::uint32_t firstTriangle = 0;   ///< number of its first triangle among all
    std::uint32_t firstComponent = 0;  ///< number of its first component among all
    /// Of each component: the winding (1: counter-clockwise) of those of its triangles that can be seen; 0: of all.
    std::vector<int> seenWinding;
    std::vector<const Mask*> masks;  ///< of its materials; empty where none cuts holes
    glm::dmat3 viewFromMesh{1};      ///< of directions
    glm::dvec3 pivot{0};             ///< view space
    glm::dmat3 normalMatrix{1};      ///< view space from mesh space, for directions across surfaces
};

/// A vertex: its number among all, the same for all that lie in one place of a mesh.
struct ViewedVertex {
    std::uint32_t number = 0;
    glm::dvec3 at{0};  ///< view space, normalized units
};

class ViewedScene {
public:
    /// `meshOf`, `edgesOf`: of each instance. Keeps references.
    ViewedScene(const SceneAt& scene, std::span<const TriMesh* const> meshOf,
        std::span<const TriangleEdges* const> edgesOf, const View& view);

    const SceneAt& scene() const { return scene_; }
    const Projector& projector() const { return projector_; }
    std::span<const ViewedMesh> meshes() const { return meshes_; }
    std::size_t triangleCount() const { return triangleCount_; }
    std::size_t vertexCount() const { return at_.size(); }

    /// The mesh that has a triangle.
    const ViewedMesh& meshOf(std::uint32_t triangle) const;
    ViewedVertex vertex(const ViewedMesh& mesh, std::uint32_t position) const {
        const std::uint32_t number = mesh.firstVertex + mesh.edges->vertexOf[position];
        return {number, at_[number]};
    }
    /// A point of a mesh's own, counted from its pivot.
    glm::dvec3 viewed(const ViewedMesh& mesh, const glm::vec3& p) const {
        return mesh.viewFromMesh * glm::dvec3(p) + mesh.pivot;
    }
    const glm::dvec3& at(std::uint32_t vertex) const { return at_[vertex]; }
    /// What cuts holes into a triangle; null: nothing.
    const Mask* maskOf(const ViewedMesh& mesh, std::uint32_t triangleOfMesh) const {
        if (mesh.masks.empty()) return nullptr;
        return mesh.masks[mesh.mesh->triangleMaterial.empty() ? 0 : mesh.mesh->triangleMaterial[triangleOfMesh]];
    }
    /// Is a triangle part of a closed surface that is seen from outside, and turned away from the eye? It cannot be
    /// seen.
    bool turnsAway(const ViewedMesh& mesh, std::uint32_t triangleOfMesh) const;
    std::array<ViewedVertex, 3> corners(const ViewedMesh& mesh, std::uint32_t triangleOfMesh) const;

private:
    const SceneAt& scene_;
    Projector projector_;
    HoleMasks masks_;
    std::vector<ViewedMesh> meshes_;  ///< of each instance
    std::vector<glm::dvec3> at_;      ///< of each vertex; view space, normalized units
    std::size_t triangleCount_ = 0;
};

}  // namespace limn
