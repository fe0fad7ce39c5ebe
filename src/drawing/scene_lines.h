// All lines of a scene as a camera sees them.
#pragma once

#include "drawing/drawn_line.h"
#include "drawing/edge_table.h"
#include "graph/graph.h"
#include "stage/scene_at.h"

#include <span>

namespace limn {

/// The meshes of one frame for passes that draw their lines. Keeps the lines of the last view that asked, so that tiles
/// share them.
class SceneLines : public HostScene {
public:
    /// `meshOf`, `edgesOf`: of each instance. Keeps references.
    SceneLines(const SceneAt& scene, std::vector<const TriMesh*> meshOf, std::vector<const TriangleEdges*> edgesOf);

    /// The lines in the picture, in an order that does not depend on threads. Throws Error (out of memory).
    const std::vector<DrawnLine>& lines(const View& view, const MeshLineRequest& request) const;

    std::span<const LineRecord> records() const { return scene_.lineRecords; }

private:
    struct Kept {
        View view;
        MeshLineRequest request;
        std::vector<DrawnLine> lines;
    };
    const SceneAt& scene_;
    std::vector<const TriMesh*> meshOf_;
    std::vector<const TriangleEdges*> edgesOf_;
    mutable std::vector<Kept> kept_;  ///< one of each request
};

}  // namespace limn
