#include "drawing/scene_lines.h"

#include "drawing/chains.h"
#include "drawing/occluders.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace limn {
namespace {

/// Do two views show the same, whatever their tiles and samples?
bool showsSame(const View& a, const View& b) {
    const Projector one(a), other(b);
    return a.imageSize == b.imageSize && a.orthographic == b.orthographic && a.eye == b.eye
        && a.viewFromRelative == b.viewFromRelative && one.rayScale == other.rayScale
        && one.rayOffset == other.rayOffset && a.near == b.near;
}

/// The pieces of each candidate, in its order.
std::vector<LinePiece> piecesOf(
    const ViewedScene& scene, const std::vector<Candidate>& candidates, const Occluders& occluders, int deepest) {
    constexpr std::size_t kPart = 256;
    // Inner nodes are numbered after all vertices: so many for each candidate, whatever others have.
    std::vector<std::vector<LinePiece>> parts((candidates.size() + kPart - 1) / kPart);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        for (std::size_t i = part * kPart; i < std::min(candidates.size(), (part + 1) * kPart); ++i) {
            const Candidate& line = candidates[i];
            const auto found = occluders.partsOf(line, deepest);
            const auto pointAt = [&](double t) {
                const glm::dvec3 p = line.end[0] + (line.end[1] - line.end[0]) * t;
                return LinePoint{scene.projector().place(p), -p.z};
            };
            for (std::size_t k = 0; k < found.size(); ++k) {
                LinePiece piece{
                    {pointAt(found[k].from), pointAt(found[k].to)}, {}, static_cast<std::uint32_t>(i), found[k].behind};
                const auto inner = [&](std::size_t number) {
                    return std::uint64_t{1} << 62 | static_cast<std::uint64_t>(i) << 24 | (number & 0xFFFFFF);
                };
                if (found[k].from == 0)
                    piece.node[0] = line.node[0];
                else if (k > 0 && found[k - 1].to == found[k].from)
                    piece.node[0] = inner(k);
                if (found[k].to == 1)
                    piece.node[1] = line.node[1];
                else if (k + 1 < found.size() && found[k].to == found[k + 1].from)
                    piece.node[1] = inner(k + 1);
                parts[part].push_back(piece);
            }
        }
    });
    std::vector<LinePiece> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace

SceneLines::SceneLines(
    const SceneAt& scene, std::vector<const TriMesh*> meshOf, std::vector<const TriangleEdges*> edgesOf)
    : scene_(scene), meshOf_(std::move(meshOf)), edgesOf_(std::move(edgesOf)) {}

const std::vector<DrawnLine>& SceneLines::lines(const View& view, const MeshLineRequest& request) const {
    for (const auto& kept : kept_)
        if (kept.request == request && showsSame(kept.view, view)) return kept.lines;
    std::erase_if(kept_, [&](const Kept& kept) { return kept.request == request || !showsSame(kept.view, view); });
    const ViewedScene viewed(scene_, meshOf_, edgesOf_, view);
    const std::vector<Candidate> candidates = findCandidates(viewed, request);
    const Occluders occluders(viewed, view.imageSize, request.margin);
    std::vector<LinePiece> pieces = piecesOf(viewed, candidates, occluders, request.deepest);
    removeOverlaps(pieces, candidates, request.deepest);
    kept_.push_back({view, request, chain(pieces, candidates, request.deepest)});
    return kept_.back().lines;
}

}  // namespace limn
