#include "formats/inspect.h"

#include "base/text.h"
#include "mesh/coincident.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limn {

MeshFacts inspectMesh(const std::filesystem::path& path) {
    MeshFile file = meshFormat(path).read(path);
    requireFaces(file);
    repairTopology(file.poly, file.warnings);
    const PolyMesh& mesh = file.poly;
    MeshFacts facts;
    facts.file = path.string();
    facts.faces = mesh.faceCount();
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const auto size = mesh.faceStart[f + 1] - mesh.faceStart[f];
        ++(size == 3 ? facts.triangles : size == 4 ? facts.quads : facts.largerFaces);
    }
    facts.uvs = mesh.uvs.size();
    facts.normals = mesh.normals.size();
    facts.lines = mesh.lines.size();
    facts.materials = mesh.materialNames;
    facts.parts = mesh.partNames;
    facts.creases = mesh.tags.creases.size();
    facts.corners = mesh.tags.corners.size();
    facts.holes = mesh.tags.holes.size();
    for (const auto& crease : mesh.tags.creases) facts.infiniteCreases += crease.sharpness >= kInfiniteSharpness;
    for (const auto v : mesh.cornerPosition) facts.bounds.add(mesh.positions[v]);
    for (const auto& one : mesh.lines) facts.bounds.add(one.a), facts.bounds.add(one.b);
    facts.topology = analyseTopology(mesh);
    const TriMesh triangles = buildTriMesh(mesh, {});
    facts.covered = countCovered({triangles.positions, triangles.indices});
    facts.warnings = std::move(file.warnings);
    const SubdivisionOptions options = withTags({}, mesh.tags);
    facts.subdivision = describe(options, "", planSubdivision(mesh, options));
    return facts;
}

std::string meshFactsText(const MeshFacts& f) {
    const TopologyReport& t = f.topology;
    std::string out = f.file + "\n";
    const auto line = [&](std::string_view name, const std::string& value) {
        out += fmt::format("  {:<13} {}\n", name, value);
    };
    line("faces",
        fmt::format("{}: {} triangles, {} quads, {} with more sides (up to {})", f.faces, f.triangles, f.quads,
            f.largerFaces, t.largestFace));
    line("vertices",
        fmt::format(
            "{} used, {} unused; {} texture coordinates, {} normals", t.vertices, t.unusedVertices, f.uvs, f.normals));
    line("edges",
        fmt::format("{}: {} on {} boundary loop{}, {} sharper than {} degrees", t.edges, t.boundaryEdges,
            t.boundaryLoops, t.boundaryLoops == 1 ? "" : "s", t.featureEdges, kSmoothAngleDegrees));
    if (f.lines > 0) line("lines", fmt::format("{}", f.lines));
    line("pieces", fmt::format("{}", t.components));
    line("trouble",
        fmt::format("{} non-manifold edges, {} non-manifold vertices, {} edges that cannot be wound alike, {} faces "
                    "without area, {} interior vertices with two faces, {} triangles that lie on others",
            t.nonManifoldEdges, t.nonManifoldVertices, t.unorientable, t.degenerateFaces, t.valenceTwo, f.covered));
    const glm::dvec3 size = f.bounds.hi - f.bounds.lo;
    line("materials", fmt::format("{}", fmt::join(f.materials, ", ")));
    line("parts", f.parts.size() > 8 ? fmt::format("{}", f.parts.size()) : fmt::format("{}", fmt::join(f.parts, ", ")));
    line("box",
        f.bounds.empty() ? "empty"
                         : fmt::format("[{}, {}, {}] to [{}, {}, {}]: {:.6g} × {:.6g} × {:.6g}, diagonal {:.6g}",
                             f.bounds.lo.x, f.bounds.lo.y, f.bounds.lo.z, f.bounds.hi.x, f.bounds.hi.y, f.bounds.hi.z,
                             size.x, size.y, size.z, f.bounds.diagonal()));
    line("tags",
        fmt::format("{} creases ({} infinitely sharp), {} corners, {} holes", f.creases, f.infiniteCreases, f.corners,
            f.holes));
    line("subdivision", f.subdivision);
    for (const auto& w : f.warnings)
        line("warning",
            fmt::format("{}{}{}{}", w.file.empty() ? "" : w.file + ": ",
                w.firstLine > 0 ? fmt::format("line {}: ", w.firstLine) : "", w.kind,
                w.count > 1 ? fmt::format(" ({} times)", w.count) : ""));
    return out;
}

std::string meshFactsJson(const MeshFacts& f) {
    const TopologyReport& t = f.topology;
    const auto names = [](const std::vector<std::string>& list) {
        std::vector<std::string> quoted;
        quoted.reserve(list.size());
        for (const auto& name : list) quoted.push_back(jsonText(name));
        return fmt::format("[{}]", fmt::join(quoted, ", "));
    };
    std::vector<std::string> warnings;
    for (const auto& w : f.warnings)
        warnings.push_back(fmt::format("{{\"kind\": {}, \"count\": {}, \"file\": {}, \"first_line\": {}}}",
            jsonText(w.kind), w.count, jsonText(w.file.empty() ? f.file : w.file), w.firstLine));
    const auto number = [](double value) {
        return std::isfinite(value) ? fmt::format("{:.17g}", value) : std::string("null");
    };
    return fmt::format(
        "{{\"file\": {}, \"faces\": {}, \"triangles\": {}, \"quads\": {}, \"larger_faces\": {}, \"largest_face\": {}, "
        "\"vertices\": {}, \"unused_vertices\": {}, \"uvs\": {}, \"normals\": {}, \"lines\": {},\n"
        " \"edges\": {}, \"boundary_edges\": {}, \"boundary_loops\": {}, \"feature_edges\": {}, \"components\": {}, "
        "\"non_manifold_edges\": {}, \"non_manifold_vertices\": {}, \"unorientable_edges\": {},\n"
        " \"degenerate_faces\": {}, \"interior_valence_two\": {}, \"covered_triangles\": {}, \"creases\": {}, "
        "\"infinite_creases\": {}, "
        "\"corners\": {}, \"holes\": {},\n"
        " \"low\": [{}, {}, {}], \"high\": [{}, {}, {}], \"materials\": {}, \"parts\": {}, \"subdivision\": {}, "
        "\"warnings\": [{}]}}",
        jsonText(f.file), f.faces, f.triangles, f.quads, f.largerFaces, t.largestFace, t.vertices, t.unusedVertices,
        f.uvs, f.normals, f.lines, t.edges, t.boundaryEdges, t.boundaryLoops, t.featureEdges, t.components,
        t.nonManifoldEdges, t.nonManifoldVertices, t.unorientable, t.degenerateFaces, t.valenceTwo, f.covered,
        f.creases, f.infiniteCreases, f.corners, f.holes, number(f.bounds.lo.x), number(f.bounds.lo.y),
        number(f.bounds.lo.z), number(f.bounds.hi.x), number(f.bounds.hi.y), number(f.bounds.hi.z), names(f.materials),
        names(f.parts), jsonText(f.subdivision), fmt::join(warnings, ", "));
}

}  // namespace limn
