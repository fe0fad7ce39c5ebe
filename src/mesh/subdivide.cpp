#include "mesh/subdivide.h"

#include "base/error.h"
#include "base/memory.h"
#include "mesh/far.h"
#include "mesh/tessellate.h"
#include "mesh/topology.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace limn {
namespace {

constexpr std::size_t kMostSides = 65535;  // of a face and around a vertex, in OpenSubdiv's 16-bit counts

enum class Way : char { bfr, safe, plain };

struct Ways {
    std::vector<Way> ofFace;
    SubdivisionReport report;
};

/// Loop takes triangles only. A face may also meet itself, such as one with a hole that a doubled edge joins to the
/// rim. Its vertices then have more faces than edges, and OpenSubdiv reads past their end.
bool mustBeCut(const PolyMesh& mesh, std::size_t face, const SubdivisionOptions& options) {
    const auto first = mesh.cornerPosition.begin() + mesh.faceStart[face],
               last = mesh.cornerPosition.begin() + mesh.faceStart[face + 1];
    if (options.scheme == SubdivisionScheme::loop && last - first > 3) return true;
    std::vector<std::uint32_t> corners(first, last);
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

Ways chooseWays(const PolyMesh& cage, const SubdivisionOptions& options) {
    Ways ways;
    const EdgeTable table = findEdges(cage);
    const Components components = findComponents(cage);
    ways.report.faces = cage.faceCount();
    ways.report.components = components.count;
    for (const auto& crease : cage.tags.creases)
        if (table.find(crease.a, crease.b) < 0) ++ways.report.missingCreases;

    std::vector<Way> ofComponent(
        components.count, options.safe || options.chaikin || !options.limit ? Way::safe : Way::bfr);
    if (options.chaikin)
        ways.report.safeReason = "Chaikin creases";
    else if (!options.limit)
        ways.report.safeReason = "plain refinement";
    else if (options.safe)
        ways.report.safeReason = "asked for";

    std::vector<std::uint32_t> faces(cage.positions.size(), 0), edges(cage.positions.size(), 0);
    for (const auto v : cage.cornerPosition) ++faces[v];
    std::vector<std::uint32_t> rims(cage.positions.size(), 0);
    std::vector<char> branches(cage.positions.size(), 0);
    for (const auto& edge : table.edges)
        for (const auto v : {edge.a, edge.b}) {
            ++edges[v];
            rims[v] += edge.useCount == 1;
            branches[v] = branches[v] || edge.useCount > 2;
        }
    // Bfr 3.5 reads past the faces around a vertex where creases meet several fans of faces.
    std::vector<char> creased(components.count, 0);
    for (const auto& crease : cage.tags.creases)
        if (const auto e = table.find(crease.a, crease.b); e >= 0)
            creased[components.ofFace[table.uses[table.edges[static_cast<std::size_t>(e)].firstUse].face]] = 1;
    for (std::size_t f = 0; f < cage.faceCount(); ++f) {
        Way& way = ofComponent[components.ofFace[f]];
        for (std::uint32_t c = cage.faceStart[f]; c < cage.faceStart[f + 1]; ++c) {
            const std::uint32_t v = cage.cornerPosition[c];
            if (faces[v] == 2 && edges[v] == 2 && way == Way::bfr) {
                way = Way::safe;
                ways.report.safeReason = "an interior vertex with two faces";
            }
            if ((branches[v] || rims[v] > 2) && way == Way::bfr && creased[components.ofFace[f]]) {
                way = Way::safe;
                ways.report.safeReason = "creases on a non-manifold piece";
            }
            if (edges[v] > kMostSides || faces[v] > kMostSides) way = Way::plain;
        }
        if (cage.faceStart[f + 1] - cage.faceStart[f] > kMostSides) way = Way::plain;
    }
    ways.report.safeComponents =
        static_cast<std::size_t>(std::count(ofComponent.begin(), ofComponent.end(), Way::safe));
    for (std::size_t f = 0; f < cage.faceCount(); ++f) {
        ways.ofFace.push_back(ofComponent[components.ofFace[f]]);
        ways.report.safeFaces += ways.ofFace.back() == Way::safe;
        ways.report.plainFaces += ways.ofFace.back() == Way::plain;
        ways.report.splitFaces += mustBeCut(cage, f, options);
    }
    return ways;
}

/// The faces of one way, with everything they refer to.
PolyMesh part(const PolyMesh& cage, const std::vector<Way>& ways, Way way) {
    std::vector<char> keep(ways.size());
    std::transform(ways.begin(), ways.end(), keep.begin(), [&](Way w) { return w == way; });
    PolyMesh mesh = cage;
    keepFaces(mesh, keep);
    return mesh;
}

void append(TriMesh& to, const TriMesh& from) {
    const auto shift = [](std::vector<std::uint32_t>& indices, const std::vector<std::uint32_t>& more, std::size_t by) {
        for (const auto i : more) indices.push_back(i + static_cast<std::uint32_t>(by));
    };
    const std::size_t before = to.triangleCount();
    shift(to.indices, from.indices, to.positions.size());
    shift(to.normalIndices, from.normalIndices, to.normals.size());
    shift(to.uvIndices, from.uvIndices, to.uvs.size());
    shift(to.colorIndices, from.colorIndices, to.colors.size());
    const auto join = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
    join(to.positions, from.positions);
    join(to.normals, from.normals);
    join(to.uvs, from.uvs);
    join(to.colors, from.colors);
    const auto joinWords = [&](std::vector<std::uint32_t>& a,
                               const std::vector<std::uint32_t>& b) {  // empty means all 0
        if (a.empty() && b.empty()) return;
        a.resize(before);
        join(a, b);
        a.resize(to.triangleCount());
    };
    joinWords(to.triangleMaterial, from.triangleMaterial);
    joinWords(to.trianglePart, from.trianglePart);
}

/// Triangulates faces that OpenSubdiv cannot take, as drawing would.
PolyMesh cutIntoTriangles(const PolyMesh& mesh, const std::vector<char>& cut) {
    PolyMesh out = mesh;
    out.faceStart = {0};
    out.cornerPosition.clear();
    out.cornerUv.clear();
    out.cornerNormal.clear();
    out.faceMaterial.clear();
    out.facePart.clear();
    out.faceSmoothing.clear();
    out.tags.holes.clear();
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const std::uint32_t start = mesh.faceStart[f];
        std::vector<glm::dvec3> polygon;
        for (std::uint32_t c = start; c < mesh.faceStart[f + 1]; ++c)
            polygon.push_back(mesh.positions[mesh.cornerPosition[c]]);
        std::vector<std::uint32_t> corners(polygon.size());
        std::iota(corners.begin(), corners.end(), 0u);
        if (cut[f]) corners = triangulatePolygon(polygon);
        const std::size_t sides = cut[f] ? 3 : corners.size();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t c = start + corners[i];
            out.cornerPosition.push_back(mesh.cornerPosition[c]);
            if (!mesh.cornerUv.empty()) out.cornerUv.push_back(mesh.cornerUv[c]);
            if (!mesh.cornerNormal.empty()) out.cornerNormal.push_back(mesh.cornerNormal[c]);
            if (i % sides != sides - 1) continue;
            if (std::binary_search(mesh.tags.holes.begin(), mesh.tags.holes.end(), static_cast<std::uint32_t>(f)))
                out.tags.holes.push_back(static_cast<std::uint32_t>(out.faceCount()));
            out.faceStart.push_back(static_cast<std::uint32_t>(out.cornerPosition.size()));
            out.faceMaterial.push_back(mesh.faceMaterial[f]);
            out.facePart.push_back(mesh.facePart[f]);
            out.faceSmoothing.push_back(mesh.faceSmoothing[f]);
        }
    }
    return out;
}

}  // namespace

SubdivisionOptions withTags(SubdivisionOptions options, const SubdivisionTags& tags) {
    if (tags.boundary)
        options.boundary = *tags.boundary == 0 ? BoundaryRule::none
            : *tags.boundary == 1              ? BoundaryRule::edgeAndCorner
                                               : BoundaryRule::edgeOnly;
    if (tags.faceVaryingBoundary) options.uv = static_cast<UvRule>(*tags.faceVaryingBoundary);
    if (tags.chaikin) options.chaikin = *tags.chaikin;
    if (tags.smoothTriangles) options.smoothTriangles = *tags.smoothTriangles;
    return options;
}

SubdivisionReport planSubdivision(const PolyMesh& cage, const SubdivisionOptions& options) {
    return chooseWays(cage, options).report;
}

std::string describe(
    const SubdivisionOptions& options, const std::string& edgeLength, const SubdivisionReport& report) {
    constexpr const char* schemes[] = {"catmull-clark", "loop", "bilinear"};
    std::string text = fmt::format("{}, {}, {}", schemes[static_cast<int>(options.scheme)],
        edgeLength.empty() ? fmt::format("level {}", options.level)
                           : fmt::format("edges of {}, at most level {}", edgeLength, options.level),
        options.limit ? "limit surface" : "plain refinement");
    text += fmt::format(", {} face{} in {} component{}", report.faces, report.faces == 1 ? "" : "s", report.components,
        report.components == 1 ? "" : "s");
    if (report.safeComponents > 0)
        text += fmt::format("; {} taken the safe way: {}",
            report.safeComponents == report.components ? "all" : std::to_string(report.safeComponents),
            report.safeReason);
    if (report.plainFaces > 0) text += fmt::format("; {} faces are too large and drawn as they are", report.plainFaces);
    if (report.missingCreases > 0) text += fmt::format("; {} creases lie on no edge", report.missingCreases);
    if (report.splitFaces > 0) text += fmt::format("; {} faces cut into triangles", report.splitFaces);
    return text;
}

TriMesh subdivide(const PolyMesh& given, const SubdivisionOptions& options, const MeshNeeds& needs,
    const std::string& name, SubdivisionReport* report) {
    std::vector<char> cut(given.faceCount());
    tbb::parallel_for(std::size_t{0}, cut.size(), [&](std::size_t f) { cut[f] = mustBeCut(given, f, options); });
    const auto cuts = static_cast<std::size_t>(std::count(cut.begin(), cut.end(), 1));
    const PolyMesh pieces = cuts > 0 ? cutIntoTriangles(given, cut) : PolyMesh{};
    const PolyMesh& cage = cuts > 0 ? pieces : given;
    const Ways ways = chooseWays(cage, options);
    if (report) {
        *report = ways.report;
        report->splitFaces = cuts;
    }
    const glm::dvec3 pivot = choosePivot(cage);
    const auto goes = [&](Way way) {
        return std::find(ways.ofFace.begin(), ways.ofFace.end(), way) != ways.ofFace.end();
    };
    const bool mixed = goes(Way::safe) + goes(Way::bfr) + goes(Way::plain) > 1;
    TriMesh out;
    out.pivot = pivot;
    // The layout for vertex pipelines comes from polygons alone, so its faces are refined uniformly.
    if (goes(Way::bfr) && !needs.unified)
        out = tessellate(mixed ? part(cage, ways.ofFace, Way::bfr) : cage, options, needs, pivot, true, name);
    const auto addPolygons = [&](const PolyMesh& mesh) {
        if (mesh.faceCount() > 0) append(out, triangulateMesh(mesh, needs, pivot));
    };
    // Uniform refinement makes the faces of all levels: 1 1/3 times the last one's, of about 300 bytes each.
    std::optional<MemoryClaim> claim;
    const bool isUniform = (goes(Way::bfr) && needs.unified) || goes(Way::safe);
    if (const std::uint64_t faces = std::uint64_t{cage.cornerPosition.size()} << 2 * std::max(options.level - 1, 0);
        isUniform)
        claim.emplace(faces * 400, Location{name}, fmt::format("subdivision makes {} faces", faces), kFewerTriangles);
    if (goes(Way::bfr) && needs.unified)
        addPolygons(refineUniformly(mixed ? part(cage, ways.ofFace, Way::bfr) : cage, options, needs.normals));
    // Far's patches are evaluated like Bfr's. They take any rates and, unlike uniform refinement, know the limit of a
    // vertex with two faces.
    const bool patches = options.limit && !options.safe && (!options.chaikin || options.edgeRate)
        && options.scheme != SubdivisionScheme::bilinear && !needs.unified;
    if (goes(Way::safe) && patches)
        append(out, tessellate(mixed ? part(cage, ways.ofFace, Way::safe) : cage, options, needs, pivot, false, name));
    else if (goes(Way::safe))
        addPolygons(refineUniformly(mixed ? part(cage, ways.ofFace, Way::safe) : cage, options, needs.normals));
    if (goes(Way::plain)) addPolygons(part(cage, ways.ofFace, Way::plain));
    if (out.triangleCount() == 0)
        throw Error(ExitCode::badData, {name}, "subdivision leaves no surface",
            "holes or the boundary rule remove every face: change 'boundary', or leave 'subdivision' out");
    out.segments = segmentsOf(cage, pivot);
    if (!needs.unified) numberByLastVertex(out);
    return out;
}

}  // namespace limn
