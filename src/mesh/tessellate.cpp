#include "mesh/tessellate.h"

#include "base/memory.h"
#include "mesh/far_limit.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/sdc/crease.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <shared_mutex>

namespace limn {
namespace {

using namespace OpenSubdiv;
using Factory = Bfr::RefinerSurfaceFactory<Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex,
    std::shared_lock<std::shared_mutex>, std::unique_lock<std::shared_mutex>>>;

const Bfr::Surface<double>::PointDescriptor kPoint(3), kUv(2), kColor(3);

/// How a face is cut: the same for all faces of a size with the same rates.
struct Pattern {
    std::vector<glm::dvec2> coords;     ///< boundary first: each corner, then the points of the edge after it
    std::vector<std::uint32_t> facets;  ///< three coords per triangle
    std::size_t boundary = 0;

    std::size_t interior() const { return coords.size() - boundary; }
};

Pattern makePattern(const Bfr::Parameterization& parameterization, const std::vector<int>& rates) {
    Bfr::Tessellation::Options options;
    options.SetFacetSize(3);
    const Bfr::Tessellation tessellation(parameterization, static_cast<int>(rates.size()), rates.data(), options);
    Pattern pattern;
    pattern.boundary = static_cast<std::size_t>(tessellation.GetNumBoundaryCoords());
    std::vector<double> coords(static_cast<std::size_t>(tessellation.GetNumCoords()) * 2);
    tessellation.GetCoords(coords.data());
    for (std::size_t i = 0; i < coords.size(); i += 2) pattern.coords.emplace_back(coords[i], coords[i + 1]);
    std::vector<int> facets(static_cast<std::size_t>(tessellation.GetNumFacets()) * 3);
    tessellation.GetFacets(facets.data());
    pattern.facets.assign(facets.begin(), facets.end());
    return pattern;
}

/// A place well inside the face, or inside the part that holds uv: an n-gon's parameters are one quarter square per
/// corner.
glm::dvec2 inwards(const Bfr::Parameterization& p, const glm::dvec2& uv) {
    switch (p.GetType()) {
        case Bfr::Parameterization::TRI: return {1.0 / 3, 1.0 / 3};
        case Bfr::Parameterization::QUAD_SUBFACES: return glm::floor(uv) + 0.25;
        default: return {0.5, 0.5};
    }
}

class Tessellator {
public:
    Tessellator(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs,
        const glm::dvec3& pivot, bool byBfr, const std::string& name)
        : cage_(cage),
          options_(options),
          needs_(needs),
          pivot_(pivot),
          name_(name),
          byBfr_(byBfr),
          withUvs_(needs.uvs && !cage.cornerUv.empty()),
          withColors_(needs.colors && !cage.colors.empty()),
          refiner_(makeRefiner(cage, options, withUvs_)),
          base_(refiner_->GetLevel(0)) {}

    TriMesh run() {
        findRates();
        findSharpPlaces();
        for (const auto& p : cage_.positions) points_.push_back(p - pivot_);
        if (withUvs_) uvPoints_ = uvValues(cage_);
        if (withColors_) colorPoints_.assign(cage_.colors.begin(), cage_.colors.end());
        if (!byBfr_)
            patches_ = std::make_unique<FarLimit>(
                *refiner_, std::clamp(levelsOfCreases(cage_.tags), 6, 9), points_, uvPoints_);
        const Factory factory(*refiner_, factoryOptions());
        layOut(factory);
        tbb::enumerable_thread_specific<Scratch> scratch;
        tbb::parallel_for(0, base_.GetNumFaces(), [&](int f) { evaluate(factory, f, scratch.local()); });
        mendNormals();
        return std::move(out_);
    }

private:
    struct Scratch {
        int face = 0;
        Bfr::Parameterization parameterization;
        Bfr::Surface<double> surface, uvSurface, colorSurface;
        std::vector<double> patch, uvPatch, colorPatch;
        std::map<std::vector<int>, Pattern> patterns;
    };

    void findRates() {
        rate_.assign(static_cast<std::size_t>(base_.GetNumEdges()), 1 << options_.level);
        if (!options_.edgeRate) return;
        tbb::parallel_for(0, base_.GetNumEdges(), [&](int e) {
            const auto ends = base_.GetEdgeVertices(e);
            rate_[static_cast<std::size_t>(e)] =
                std::clamp(options_.edgeRate(cage_.positions[static_cast<std::size_t>(ends[0])],
                               cage_.positions[static_cast<std::size_t>(ends[1])]),
                    1, 1 << options_.level);
        });
    }

    /// Marks edges and vertices where each face has its own normal.
    void findSharpPlaces() {
        const bool all = options_.scheme == SubdivisionScheme::bilinear;
        sharpEdge_.resize(static_cast<std::size_t>(base_.GetNumEdges()));
        sharpVertex_.resize(static_cast<std::size_t>(base_.GetNumVertices()));
        for (int e = 0; e < base_.GetNumEdges(); ++e)
            sharpEdge_[static_cast<std::size_t>(e)] = base_.GetEdgeFaces(e).size() > 1
                && (all || Sdc::Crease::IsInfinite(base_.GetEdgeSharpness(e)) || base_.IsEdgeNonManifold(e));
        for (int v = 0; v < base_.GetNumVertices(); ++v) {
            int edges = 0;
            for (const auto e : base_.GetVertexEdges(v)) edges += sharpEdge_[static_cast<std::size_t>(e)];
            // A single sharp edge ends here as a dart, which is smooth. A rim that no sharp edge runs into is smooth
            // too.
            sharpVertex_[static_cast<std::size_t>(v)] = all || base_.IsVertexNonManifold(v)
                || Sdc::Crease::IsInfinite(base_.GetVertexSharpness(v)) || edges > (base_.IsVertexBoundary(v) ? 0 : 1);
        }
    }

    Factory::Options factoryOptions() const {
        const int most = rate_.empty() ? 1 : *std::max_element(rate_.begin(), rate_.end());
        // Bfr's own 2 and 6 leave errors of a hundredth of the diagonal and of many degrees; these cost a third more
        // time.
        int fine = std::max(4, static_cast<int>(std::bit_width(static_cast<unsigned>(most - 1)))) + 1;
        if (const int creases = levelsOfCreases(cage_.tags); creases > 0) fine = std::max(fine, creases + 2);
        Factory::Options options;
        options.SetApproxLevelSmooth(std::min(fine, 10));
        options.SetApproxLevelSharp(10);
        options.SetDefaultFVarID(0);
        return options;
    }

    std::vector<int> ratesOf(int face) const {
        const auto edges = base_.GetFaceEdges(face);
        std::vector<int> rates;
        for (const auto e : edges) rates.push_back(rate_[static_cast<std::size_t>(e)]);
        // Inner rates too: Bfr's own choice makes fans of quads whose edges are not cut.
        if (edges.size() == 4) {
            rates.push_back(std::max(rates[0], rates[2]));
            rates.push_back(std::max(rates[1], rates[3]));
        } else
            rates.push_back(*std::max_element(rates.begin(), rates.end()));
        return rates;
    }

    const Pattern& patternOf(const Factory& factory, int face, std::map<std::vector<int>, Pattern>& known) const {
        const std::vector<int> rates = ratesOf(face);
        std::vector<int> key = rates;
        key.push_back(base_.GetFaceVertices(face).size());  // quads and pentagons both have six rates
        const auto found = known.find(key);
        if (found != known.end()) return found->second;
        if (known.size() > 2000) known.clear();  // rates fitted to a view repeat little
        Pattern pattern = makePattern(factory.GetFaceParameterization(face), rates);
        return known.emplace(std::move(key), std::move(pattern)).first->second;
    }

    bool sharpAt(int face, int corner, bool atVertex) const {
        return atVertex ? sharpVertex_[static_cast<std::size_t>(base_.GetFaceVertices(face)[corner])]
                        : sharpEdge_[static_cast<std::size_t>(base_.GetFaceEdges(face)[corner])];
    }

    /// Calls use(i, corner, k) for each boundary coord i of a face: k = 0 at the corner, else the k-th point of the
    /// edge after it.
    template <class Use>
    void forBoundary(int face, Use&& use) const {
        const auto edges = base_.GetFaceEdges(face);
        std::size_t i = 0;
        for (int corner = 0; corner < edges.size(); ++corner)
            for (int k = 0; k < rate_[static_cast<std::size_t>(edges[corner])]; ++k) use(i++, corner, k);
    }

    /// Gives every point, normal, uv and triangle its place, so that faces can then be evaluated in any order.
    void layOut(const Factory& factory) {
        const auto faces = static_cast<std::size_t>(base_.GetNumFaces());
        std::vector<std::uint32_t> interior(faces, 0), triangles(faces, 0), ownNormals(faces, 0), coords(faces, 0);
        tbb::enumerable_thread_specific<std::map<std::vector<int>, Pattern>> known;
        tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t f) {
            const int face = static_cast<int>(f);
            if (!factory.FaceHasLimitSurface(face)) return;
            const Pattern& pattern = patternOf(factory, face, known.local());
            interior[f] = static_cast<std::uint32_t>(pattern.interior());
            triangles[f] = static_cast<std::uint32_t>(pattern.facets.size() / 3);
            coords[f] = static_cast<std::uint32_t>(pattern.coords.size());
            forBoundary(face, [&](std::size_t, int corner, int k) { ownNormals[f] += sharpAt(face, corner, k == 0); });
        });
        drawn_.resize(faces);
        for (std::size_t f = 0; f < faces; ++f) drawn_[f] = triangles[f] > 0;
        const std::uint64_t made = std::accumulate(triangles.begin(), triangles.end(), std::uint64_t{0});
        claim_.emplace(made * kTriangleBytes, Location{name_}, fmt::format("subdivision makes {} triangles", made),
            kFewerTriangles);

        constexpr int none = -1;
        vertexOwner_.assign(static_cast<std::size_t>(base_.GetNumVertices()), none);
        edgeOwner_.assign(static_cast<std::size_t>(base_.GetNumEdges()), none);
        for (int f = 0; f < base_.GetNumFaces(); ++f) {
            if (!drawn_[static_cast<std::size_t>(f)]) continue;
            for (const auto v : base_.GetFaceVertices(f))
                if (int& owner = vertexOwner_[static_cast<std::size_t>(v)]; owner == none) owner = f;
            for (const auto e : base_.GetFaceEdges(f))
                if (int& owner = edgeOwner_[static_cast<std::size_t>(e)]; owner == none) owner = f;
        }
        std::size_t next = static_cast<std::size_t>(base_.GetNumVertices());
        for (int e = 0; e < base_.GetNumEdges(); ++e) {
            edgeStart_.push_back(static_cast<std::uint32_t>(next));
            next += static_cast<std::size_t>(rate_[static_cast<std::size_t>(e)] - 1);
        }
        const auto place = [](const std::vector<std::uint32_t>& counts, std::size_t start,
                               std::vector<std::uint32_t>& starts) {
            for (const auto count : counts) {
                starts.push_back(static_cast<std::uint32_t>(start));
                start += count;
            }
            return start;
        };
        const std::size_t positions = place(interior, next, interiorStart_);
        const std::size_t normals = place(ownNormals, positions, normalStart_);
        const std::size_t allCoords = place(coords, 0, coordStart_);
        const std::size_t count = place(triangles, 0, triangleStart_);
        out_.pivot = pivot_;
        out_.positions.resize(positions);
        out_.indices.resize(3 * count);
        if (needs_.normals) {
            out_.normals.resize(normals);
            out_.normalIndices.resize(3 * count);
        }
        if (needs_.uvs) {
            out_.uvs.resize(withUvs_ ? allCoords : 1);
            out_.uvIndices.resize(3 * count);
        }
        if (withColors_) {
            out_.colors.resize(allCoords);
            out_.colorIndices.resize(3 * count);
        }
        const auto any = [](const auto& values) {
            return std::any_of(values.begin(), values.end(), [](auto v) { return v != 0; });
        };
        if (any(cage_.faceMaterial)) out_.triangleMaterial.resize(count);
        if (any(cage_.facePart)) out_.trianglePart.resize(count);
    }

    struct Place {
        std::uint32_t position, normal;
        bool writesPosition, writesNormal;
    };

    void evaluate(const Factory& factory, int face, Scratch& s) {
        const auto f = static_cast<std::size_t>(face);
        if (!drawn_[f]) return;
        const Pattern& pattern = patternOf(factory, face, s.patterns);
        s.face = face;
        s.parameterization = factory.GetFaceParameterization(face);
        if (byBfr_) {
            factory.InitVertexSurface(face, &s.surface);
            s.patch.resize(static_cast<std::size_t>(s.surface.GetNumPatchPoints()) * 3);
            s.surface.PreparePatchPoints(&points_.data()->x, kPoint, s.patch.data(), kPoint);
        }

        std::vector<Place> places(pattern.coords.size());
        const auto vertices = base_.GetFaceVertices(face);
        const auto edges = base_.GetFaceEdges(face);
        std::uint32_t ownNormal = normalStart_[f];
        forBoundary(face, [&](std::size_t i, int corner, int k) {
            Place& place = places[i];
            bool owns, sharp;
            if (k == 0) {
                const auto v = static_cast<std::size_t>(vertices[corner]);
                place.position = static_cast<std::uint32_t>(v);
                owns = vertexOwner_[v] == face;
                sharp = sharpVertex_[v];
            } else {
                const auto e = static_cast<std::size_t>(edges[corner]);
                // The edge's own direction decides the order of its points; a face may run along it the other way.
                const bool forward = base_.GetEdgeVertices(edges[corner])[0] == vertices[corner];
                place.position = edgeStart_[e] + static_cast<std::uint32_t>(forward ? k - 1 : rate_[e] - 1 - k);
                owns = edgeOwner_[e] == face;
                sharp = sharpEdge_[e];
            }
            place.writesPosition = owns;
            place.normal = sharp ? ownNormal++ : place.position;
            place.writesNormal = sharp || owns;
        });
        for (std::size_t i = pattern.boundary; i < places.size(); ++i) {
            const std::uint32_t at = interiorStart_[f] + static_cast<std::uint32_t>(i - pattern.boundary);
            places[i] = {at, at, true, true};
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Place& place = places[i];
            const bool normal = needs_.normals && place.writesNormal;
            if (!place.writesPosition && !normal) continue;
            glm::dvec3 point, du, dv;
            if (normal)
                evaluateAt(s, pattern.coords[i], point, du, dv);
            else
                evaluateAt(s, pattern.coords[i], point);
            if (place.writesPosition) out_.positions[place.position] = point;
            if (normal) out_.normals[place.normal] = normalAt(s, pattern.coords[i], du, dv);
        }
        if (withUvs_) {
            if (byBfr_) {
                factory.InitFaceVaryingSurface(face, &s.uvSurface, 0);
                s.uvPatch.resize(static_cast<std::size_t>(s.uvSurface.GetNumPatchPoints()) * 2);
                s.uvSurface.PreparePatchPoints(&uvPoints_.data()->x, kUv, s.uvPatch.data(), kUv);
            }
            for (std::size_t i = 0; i < pattern.coords.size(); ++i)
                out_.uvs[coordStart_[f] + i] = uvAt(s, pattern.coords[i]);
        }
        if (withColors_) {  // bilinear between the cage's vertices
            factory.InitVaryingSurface(face, &s.colorSurface);
            s.colorPatch.resize(static_cast<std::size_t>(s.colorSurface.GetNumPatchPoints()) * 3);
            s.colorSurface.PreparePatchPoints(&colorPoints_.data()->x, kColor, s.colorPatch.data(), kColor);
            for (std::size_t i = 0; i < pattern.coords.size(); ++i) {
                glm::dvec3 color;
                s.colorSurface.Evaluate(&pattern.coords[i].x, s.colorPatch.data(), kColor, &color.x);
                out_.colors[coordStart_[f] + i] = color;
            }
        }
        const std::size_t first = triangleStart_[f];
        for (std::size_t i = 0; i < pattern.facets.size(); ++i) {
            const std::uint32_t coord = pattern.facets[i];
            out_.indices[3 * first + i] = places[coord].position;
            if (needs_.normals) out_.normalIndices[3 * first + i] = places[coord].normal;
            if (needs_.uvs) out_.uvIndices[3 * first + i] = withUvs_ ? coordStart_[f] + coord : 0;
            if (withColors_) out_.colorIndices[3 * first + i] = coordStart_[f] + coord;
        }
        for (std::size_t t = first; t < first + pattern.facets.size() / 3; ++t) {
            if (!out_.triangleMaterial.empty()) out_.triangleMaterial[t] = cage_.faceMaterial[f];
            if (!out_.trianglePart.empty()) out_.trianglePart[t] = cage_.facePart[f];
        }
    }

    /// Far's patches number the quarters of irregular faces by corner.
    static std::pair<int, glm::dvec2> partOf(const Scratch& s, const glm::dvec2& uv) {
        if (!s.parameterization.HasSubFaces()) return {0, uv};
        glm::dvec2 within;
        const int part = s.parameterization.ConvertCoordToNormalizedSubFace(&uv.x, &within.x);
        return {part, within};
    }

    void evaluateAt(const Scratch& s, const glm::dvec2& uv, glm::dvec3& point, glm::dvec3& du, glm::dvec3& dv) const {
        if (byBfr_) return void(s.surface.Evaluate(&uv.x, s.patch.data(), kPoint, &point.x, &du.x, &dv.x));
        const auto [part, st] = partOf(s, uv);
        patches_->evaluate(s.face, part, st, point, du, dv);
    }

    /// Without the derivatives, which only normals need.
    void evaluateAt(const Scratch& s, const glm::dvec2& uv, glm::dvec3& point) const {
        if (byBfr_) return void(s.surface.Evaluate(&uv.x, s.patch.data(), kPoint, &point.x));
        glm::dvec3 du, dv;
        evaluateAt(s, uv, point, du, dv);
    }

    glm::dvec2 uvAt(const Scratch& s, const glm::dvec2& at) const {
        glm::dvec2 uv;
        if (byBfr_) {
            s.uvSurface.Evaluate(&at.x, s.uvPatch.data(), kUv, &uv.x);
            return uv;
        }
        const auto [part, st] = partOf(s, at);
        return patches_->uv(s.face, part, st);
    }

    /// Derivatives vanish at smooth corners of rims, collapsed edges and the like: there the normal just inside the
    /// face is the limit.
    glm::vec3 normalAt(Scratch& s, const glm::dvec2& uv, glm::dvec3 du, glm::dvec3 dv) const {
        const auto unit = [](const glm::dvec3& a, const glm::dvec3& b) {
            const double product = glm::length(a) * glm::length(b);
            const glm::dvec3 n = glm::cross(a, b);
            return product > 0 && glm::length(n) > 1e-7 * product ? glm::normalize(n) : glm::dvec3(0);
        };
        glm::dvec3 n = unit(du, dv);
        const glm::dvec2 centre = inwards(s.parameterization, uv);
        for (double step = 1e-4; glm::dot(n, n) == 0 && step < 0.2; step *= 10) {
            const glm::dvec2 inside = glm::mix(uv, centre, step);
            glm::dvec3 point;
            evaluateAt(s, inside, point, du, dv);
            n = unit(du, dv);
        }
        return n;
    }

    /// Gives missing normals the mean of their triangles', and drops triangles without area.
    void mendNormals() {
        const std::size_t count = out_.triangleCount();
        const auto position = [&](std::size_t i) { return glm::dvec3(out_.positions[out_.indices[i]]); };
        if (needs_.normals) {
            const auto isZero = [](const glm::vec3& n) { return n == glm::vec3(0); };
            if (std::any_of(out_.normals.begin(), out_.normals.end(), isZero)) {
                std::vector<glm::dvec3> sum(out_.normals.size(), glm::dvec3(0)),
                    one(out_.normals.size(), glm::dvec3(0));
                for (std::size_t t = 0; t < count; ++t) {
                    const glm::dvec3 area =
                        glm::cross(position(3 * t + 1) - position(3 * t), position(3 * t + 2) - position(3 * t));
                    for (std::size_t k = 0; k < 3; ++k) sum[out_.normalIndices[3 * t + k]] += area;
                    if (glm::length(area) > 0)
                        for (std::size_t k = 0; k < 3; ++k) one[out_.normalIndices[3 * t + k]] = area;
                }
                for (std::size_t i = 0; i < sum.size(); ++i)
                    if (isZero(out_.normals[i]) && glm::length(one[i]) > 0)
                        out_.normals[i] =
                            glm::normalize(glm::length(sum[i]) > 1e-6 * glm::length(one[i]) ? sum[i] : one[i]);
            }
        }
        std::vector<char> keep(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
            keep[t] = glm::cross(position(3 * t + 1) - position(3 * t), position(3 * t + 2) - position(3 * t))
                != glm::dvec3(0);
        });
        if (std::find(keep.begin(), keep.end(), 0) == keep.end()) return;
        struct PerTriangle {
            std::vector<std::uint32_t>& values;
            std::size_t size;
        };
        const PerTriangle lists[] = {{out_.indices, 3}, {out_.normalIndices, 3}, {out_.uvIndices, 3},
            {out_.colorIndices, 3}, {out_.triangleMaterial, 1}, {out_.trianglePart, 1}};
        for (const auto& [values, size] : lists) {
            if (values.empty()) continue;
            std::size_t kept = 0;
            for (std::size_t t = 0; t < count; ++t)
                if (keep[t])
                    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size * t), size,
                        values.begin() + static_cast<std::ptrdiff_t>(size * kept++));
            values.resize(size * kept);
        }
    }

    const PolyMesh& cage_;
    const SubdivisionOptions& options_;
    const MeshNeeds& needs_;
    glm::dvec3 pivot_;
    const std::string& name_;
    std::optional<MemoryClaim> claim_;
    bool byBfr_, withUvs_, withColors_;
    std::unique_ptr<Far::TopologyRefiner> refiner_;
    const Far::TopologyLevel& base_;
    std::vector<int> rate_, vertexOwner_, edgeOwner_;
    std::vector<char> sharpEdge_, sharpVertex_, drawn_;
    std::vector<std::uint32_t> edgeStart_, interiorStart_, normalStart_, coordStart_, triangleStart_;
    std::vector<glm::dvec3> points_;  ///< of the cage, relative to the pivot
    std::vector<glm::dvec2> uvPoints_;
    std::vector<glm::dvec3> colorPoints_;
    std::unique_ptr<FarLimit> patches_;  ///< unless by Bfr
    TriMesh out_;
};

}  // namespace

TriMesh tessellate(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs,
    const glm::dvec3& pivot, bool byBfr, const std::string& name) {
    return Tessellator(cage, options, needs, pivot, byBfr, name).run();
}

}  // namespace limn
