#include "mesh/far.h"

#include "base/error.h"
#include "mesh/topology.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/sdc/crease.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

namespace limn {
namespace {

using namespace OpenSubdiv;
using far::Value;

/// Normals of a level's corners: exact from the limit tangents where the surface is smooth at a vertex, else the mean
/// of the faces on the corner's side of the sharp edges.
class CornerNormals {
public:
    CornerNormals(const Far::TopologyLevel& level, const std::vector<glm::dvec3>& points,
        const std::vector<glm::dvec3>& limitNormals, bool flat)
        : level_(level),
          points_(points),
          limit_(limitNormals),
          flat_(flat),
          faceVectors_(static_cast<std::size_t>(level.GetNumFaces())) {
        tbb::parallel_for(0, level.GetNumFaces(), [&](int f) {
            const auto corners = level_.GetFaceVertices(f);
            const auto point = [&](int i) { return points_[static_cast<std::size_t>(corners[i])]; };
            glm::dvec3 sum(0);
            for (int i = 1; i + 1 < corners.size(); ++i)
                sum += glm::cross(point(i) - point(0), point(i + 1) - point(0));
            faceVectors_[static_cast<std::size_t>(f)] = sum;
        });
    }

    /// Appends the normals around a vertex to `normals`, and calls use(face, corner, number) for each corner there.
    template <class Use>
    void around(int vertex, std::vector<glm::vec3>& normals, Use&& use) {
        const auto faces = level_.GetVertexFaces(vertex);
        const auto corners = level_.GetVertexFaceLocalIndices(vertex);
        group_.resize(static_cast<std::size_t>(faces.size()));
        for (int i = 0; i < faces.size(); ++i) group_[static_cast<std::size_t>(i)] = i;
        const auto root = [&](int i) {
            while (group_[static_cast<std::size_t>(i)] != i) i = group_[static_cast<std::size_t>(i)];
            return i;
        };
        bool smooth = !flat_ && !isInfinite(level_.GetVertexSharpness(vertex)) && !level_.IsVertexNonManifold(vertex);
        int sharpEdges = 0;
        for (const auto edge : level_.GetVertexEdges(vertex)) {
            const auto sides = level_.GetEdgeFaces(edge);
            const bool sharp = flat_ || isInfinite(level_.GetEdgeSharpness(edge)) || sides.size() != 2;
            if (sides.size() > 1 && sharp) ++sharpEdges;
            if (sharp) continue;
            const int a = root(faces.FindIndex(sides[0])), b = root(faces.FindIndex(sides[1]));
            group_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
        // A single sharp edge ends here as a dart, which is smooth. A rim that no sharp edge runs into is smooth too.
        smooth = smooth && sharpEdges <= (level_.IsVertexBoundary(vertex) ? 0 : 1);
        if (smooth && !limit_.empty()
            && glm::dot(limit_[static_cast<std::size_t>(vertex)], limit_[static_cast<std::size_t>(vertex)]) > 0) {
            normals.emplace_back(limit_[static_cast<std::size_t>(vertex)]);
            for (int i = 0; i < faces.size(); ++i) use(faces[i], corners[i], normals.size() - 1);
            return;
        }
        // Both sides of a dart's edge share one normal.
        for (int i = 0; i < faces.size(); ++i) {
            if (!smooth && root(i) != i) continue;
            if (smooth && i != 0) break;
            glm::dvec3 sum(0);
            for (int j = 0; j < faces.size(); ++j)
                if (smooth || root(j) == i) sum += faceVectors_[static_cast<std::size_t>(faces[j])];
            normals.emplace_back(unitOrZero(sum));
            for (int j = 0; j < faces.size(); ++j)
                if (smooth || root(j) == i) use(faces[j], corners[j], normals.size() - 1);
        }
    }

private:
    static bool isInfinite(float sharpness) { return Sdc::Crease::IsInfinite(sharpness); }

    const Far::TopologyLevel& level_;
    const std::vector<glm::dvec3>& points_;
    const std::vector<glm::dvec3>& limit_;
    bool flat_;
    std::vector<glm::dvec3> faceVectors_;
    std::vector<int> group_;
};

/// Takes the UVs of a level from a deeper one: each corner of a face is a corner of one of its children, level by
/// level.
void takeDeepUvs(const Far::TopologyRefiner& refiner, int level, int depth, const std::vector<Value<2>>& deep,
    std::vector<Value<2>>& uvs) {
    const auto& first = refiner.GetLevel(level);
    for (int f = 0; f < first.GetNumFaces(); ++f) {
        const auto values = first.GetFaceFVarValues(f, 0);
        for (int corner = 0; corner < values.size(); ++corner) {
            int face = f, at = corner, vertex = first.GetFaceVertices(f)[corner];
            for (int l = level; l < depth; ++l) {
                vertex = refiner.GetLevel(l).GetVertexChildVertex(vertex);
                const auto children = refiner.GetLevel(l).GetFaceChildFaces(face);
                for (const auto child : children)
                    if (const int found = refiner.GetLevel(l + 1).GetFaceVertices(child).FindIndex(vertex);
                        found >= 0) {
                        face = child;
                        at = found;
                        break;
                    }
            }
            uvs[static_cast<std::size_t>(values[corner])] =
                deep[static_cast<std::size_t>(refiner.GetLevel(depth).GetFaceFVarValues(face, 0)[at])];
        }
    }
}

/// Uniform refinement quadruples faces per level; sharper creases than this stay sharp on the safe path.
constexpr int kDeepest = 9, kDeepestForDarts = 6;
constexpr std::size_t kMostFaces = std::size_t{1} << 21;

/// Does an infinitely sharp crease end anywhere?
bool hasDart(const SubdivisionTags& tags) {
    std::map<std::uint32_t, int> ends;
    for (const auto& crease : tags.creases)
        if (crease.sharpness >= kInfiniteSharpness) {
            ++ends[crease.a];
            ++ends[crease.b];
        }
    return std::any_of(ends.begin(), ends.end(), [](const auto& end) { return end.second == 1; });
}

}  // namespace

int levelsOfCreases(const SubdivisionTags& tags) {
    float most = 0;
    for (const auto& crease : tags.creases)
        most = std::max(most, crease.sharpness < kInfiniteSharpness ? crease.sharpness : 0);
    for (const auto& corner : tags.corners)
        most = std::max(most, corner.sharpness < kInfiniteSharpness ? corner.sharpness : 0);
    return static_cast<int>(std::ceil(most));
}

std::vector<glm::dvec2> uvValues(const PolyMesh& mesh) {
    std::vector<glm::dvec2> values(mesh.uvs.begin(), mesh.uvs.end());
    values.emplace_back(0);
    return values;
}

std::unique_ptr<Far::TopologyRefiner> makeRefiner(
    const PolyMesh& cage, const SubdivisionOptions& options, bool withUvs) {
    std::vector<int> sizes(cage.faceCount()), corners(cage.cornerPosition.begin(), cage.cornerPosition.end());
    for (std::size_t f = 0; f < sizes.size(); ++f)
        sizes[f] = static_cast<int>(cage.faceStart[f + 1] - cage.faceStart[f]);
    std::vector<int> creasePairs, cornerVertices, holes(cage.tags.holes.begin(), cage.tags.holes.end());
    std::vector<float> creaseWeights, cornerWeights;
    const auto weight = [](float sharpness) {
        return sharpness >= kInfiniteSharpness ? Sdc::Crease::SHARPNESS_INFINITE : sharpness;
    };
    if (!cage.tags.creases.empty()) {
        const EdgeTable table = findEdges(cage);
        for (const auto& crease : cage.tags.creases) {
            if (table.find(crease.a, crease.b) < 0) continue;
            creasePairs.push_back(static_cast<int>(crease.a));
            creasePairs.push_back(static_cast<int>(crease.b));
            creaseWeights.push_back(weight(crease.sharpness));
        }
    }
    for (const auto& corner : cage.tags.corners) {
        cornerVertices.push_back(static_cast<int>(corner.vertex));
        cornerWeights.push_back(weight(corner.sharpness));
    }
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(cage.positions.size());
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = corners.data();
    descriptor.numCreases = static_cast<int>(creaseWeights.size());
    descriptor.creaseVertexIndexPairs = creasePairs.data();
    descriptor.creaseWeights = creaseWeights.data();
    descriptor.numCorners = static_cast<int>(cornerWeights.size());
    descriptor.cornerVertexIndices = cornerVertices.data();
    descriptor.cornerWeights = cornerWeights.data();
    descriptor.numHoles = static_cast<int>(holes.size());
    descriptor.holeIndices = holes.data();
    std::vector<int> uvIndices;
    Far::TopologyDescriptor::FVarChannel channel;
    if (withUvs) {
        for (const auto i : cage.cornerUv)
            uvIndices.push_back(i == PolyMesh::kNone ? static_cast<int>(cage.uvs.size()) : i);
        if (cage.cornerUv.empty()) uvIndices.assign(corners.size(), static_cast<int>(cage.uvs.size()));
        channel.numValues = static_cast<int>(cage.uvs.size()) + 1;
        channel.valueIndices = uvIndices.data();
        descriptor.numFVarChannels = 1;
        descriptor.fvarChannels = &channel;
    }
    Sdc::Options rules;
    rules.SetVtxBoundaryInterpolation(options.boundary == BoundaryRule::none ? Sdc::Options::VTX_BOUNDARY_NONE
            : options.boundary == BoundaryRule::edgeOnly                     ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                         : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    constexpr Sdc::Options::FVarLinearInterpolation uvRules[] = {Sdc::Options::FVAR_LINEAR_NONE,
        Sdc::Options::FVAR_LINEAR_CORNERS_ONLY, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1,
        Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2, Sdc::Options::FVAR_LINEAR_BOUNDARIES, Sdc::Options::FVAR_LINEAR_ALL};
    rules.SetFVarLinearInterpolation(uvRules[static_cast<int>(options.uv)]);
    rules.SetCreasingMethod(options.chaikin ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
    rules.SetTriangleSubdivision(
        options.smoothTriangles ? Sdc::Options::TRI_SUB_SMOOTH : Sdc::Options::TRI_SUB_CATMARK);
    const Sdc::SchemeType scheme = options.scheme == SubdivisionScheme::catmullClark ? Sdc::SCHEME_CATMARK
        : options.scheme == SubdivisionScheme::loop                                  ? Sdc::SCHEME_LOOP
                                                                                     : Sdc::SCHEME_BILINEAR;
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(descriptor, Factory::Options(scheme, rules)));
    if (!refiner)
        throw Error(ExitCode::internal, {}, "OpenSubdiv takes no such mesh", "please report this, with the mesh");
    return refiner;
}

PolyMesh refineUniformly(const PolyMesh& cage, const SubdivisionOptions& options, bool wantNormals) {
    const bool withUvs = !cage.cornerUv.empty();
    const auto refiner = makeRefiner(cage, options, withUvs);
    // A semi-sharp crease reaches its limit only as many levels down as it is sharp. Where an infinitely sharp one ends
    // in a dart, every level comes nearer. So refine deeper, and take the points of this level there.
    const bool toLimit = options.limit && options.scheme != SubdivisionScheme::bilinear;
    int depth = options.level;
    if (toLimit)
        for (const int wanted =
                 std::max(hasDart(cage.tags) ? kDeepestForDarts : 0, std::min(levelsOfCreases(cage.tags), kDeepest));
             depth < wanted && cage.faceCount() << (2 * depth) < kMostFaces;)
            ++depth;
    Far::TopologyRefiner::UniformOptions uniform(depth);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    const Far::PrimvarRefinerReal<double> primvars(*refiner);

    std::vector<Value<3>> points(cage.positions.size());
    std::transform(
        cage.positions.begin(), cage.positions.end(), points.begin(), [](const auto& p) { return Value<3>{p}; });
    std::vector<Value<2>> uvs;
    if (withUvs)
        for (const auto& uv : uvValues(cage)) uvs.push_back({uv});
    // Colours are bilinear between the cage's vertices.
    std::vector<Value<3>> colors;
    for (const auto& color : cage.colors) colors.push_back({glm::dvec3(color)});
    for (int l = 1; l <= options.level && !colors.empty(); ++l) {
        std::vector<Value<3>> finer(static_cast<std::size_t>(refiner->GetLevel(l).GetNumVertices()));
        primvars.InterpolateVarying(l, colors, finer);
        colors = std::move(finer);
    }
    for (int l = 1; l <= depth; ++l) {
        std::vector<Value<3>> finer(static_cast<std::size_t>(refiner->GetLevel(l).GetNumVertices()));
        primvars.Interpolate(l, points, finer);
        points = std::move(finer);
        if (!withUvs || l > options.level) continue;
        std::vector<Value<2>> finerUvs(static_cast<std::size_t>(refiner->GetLevel(l).GetNumFVarValues(0)));
        primvars.InterpolateFaceVarying(l, uvs, finerUvs, 0);
        uvs = std::move(finerUvs);
    }
    const Far::TopologyLevel& last = refiner->GetLevel(options.level);
    std::vector<glm::dvec3> limitNormals;
    if (toLimit) {
        std::vector<Value<3>> limit(points.size()), du(points.size()), dv(points.size());
        // OpenSubdiv 3.5 writes past the end of its masks for tangents at non-manifold vertices. The normals of the
        // faces around serve instead.
        const Far::TopologyLevel& base = refiner->GetLevel(0);
        bool manifold = true;
        for (int v = 0; v < base.GetNumVertices() && manifold; ++v) manifold = !base.IsVertexNonManifold(v);
        if (manifold && wantNormals)
            primvars.Limit(points, limit, du, dv);
        else
            primvars.Limit(points, limit);
        points.resize(static_cast<std::size_t>(last.GetNumVertices()));
        for (int v = 0; v < last.GetNumVertices(); ++v) {
            int deep = v;
            for (int l = options.level; l < depth; ++l) deep = refiner->GetLevel(l).GetVertexChildVertex(deep);
            const auto at = static_cast<std::size_t>(deep);
            points[static_cast<std::size_t>(v)] = limit[at];
            if (wantNormals && manifold) limitNormals.push_back(unitOrZero(glm::cross(du[at].v, dv[at].v)));
        }
    }
    if (toLimit && withUvs) {
        // Face-varying limits ignore creases, but exist on the last level only.
        std::vector<Value<2>> deep = uvs;
        for (int l = options.level + 1; l <= depth; ++l) {
            std::vector<Value<2>> finer(static_cast<std::size_t>(refiner->GetLevel(l).GetNumFVarValues(0)));
            primvars.InterpolateFaceVarying(l, deep, finer, 0);
            deep = std::move(finer);
        }
        std::vector<Value<2>> limitUvs(deep.size());
        primvars.LimitFaceVarying(deep, limitUvs, 0);
        if (depth == options.level)
            uvs = std::move(limitUvs);
        else
            takeDeepUvs(*refiner, options.level, depth, limitUvs, uvs);
    }

    PolyMesh out;
    out.materialNames = cage.materialNames;
    out.partNames = cage.partNames;
    out.materialLibraries = cage.materialLibraries;
    for (const auto& p : points) out.positions.push_back(p.v);
    for (const auto& uv : uvs) out.uvs.emplace_back(uv.v);
    for (const auto& color : colors) out.colors.emplace_back(color.v);
    std::vector<std::size_t> firstCorner(static_cast<std::size_t>(last.GetNumFaces()), ~std::size_t{0});
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (last.IsFaceHole(f)) continue;
        firstCorner[static_cast<std::size_t>(f)] = out.cornerPosition.size();
        for (const auto v : last.GetFaceVertices(f)) out.cornerPosition.push_back(static_cast<std::uint32_t>(v));
        if (withUvs)
            for (const auto uv : last.GetFaceFVarValues(f, 0)) out.cornerUv.push_back(uv);
        out.faceStart.push_back(static_cast<std::uint32_t>(out.cornerPosition.size()));
        int ancestor = f;
        for (int l = options.level; l > 0; --l) ancestor = refiner->GetLevel(l).GetFaceParentFace(ancestor);
        const auto base = static_cast<std::size_t>(ancestor);
        out.faceMaterial.push_back(cage.faceMaterial[base]);
        out.facePart.push_back(cage.facePart[base]);
        out.faceSmoothing.push_back(cage.faceSmoothing[base]);
    }
    if (wantNormals) {
        out.cornerNormal.assign(out.cornerPosition.size(), PolyMesh::kNone);
        CornerNormals makeNormals(last, out.positions, limitNormals, options.scheme == SubdivisionScheme::bilinear);
        for (int v = 0; v < last.GetNumVertices(); ++v)
            makeNormals.around(v, out.normals, [&](int face, int corner, std::size_t number) {
                const std::size_t first = firstCorner[static_cast<std::size_t>(face)];
                if (first != ~std::size_t{0})
                    out.cornerNormal[first + static_cast<std::size_t>(corner)] = static_cast<std::int32_t>(number);
            });
    }
    return out;
}

}  // namespace limn
