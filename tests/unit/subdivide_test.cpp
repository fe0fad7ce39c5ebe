// Subdivision against independent implementations: OpenSubdiv's uniform refinement and limit, and the point sets that
// Hbr made.

#include "mesh/subdivide.h"
#include "base/error.h"
#include "formats/obj.h"
#include "mesh/topology.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <unordered_map>

namespace limn {
namespace {

std::filesystem::path dataFolder() {
    const char* data = std::getenv("LIMN_TEST_DATA");
    return data ? data : "";
}

std::vector<std::filesystem::path> shapes(const char* folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(dataFolder() / folder))
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// A cage as Pixar's tests mean it: the scheme is in the file's name, and without a tag rims follow edge-only.
struct Cage {
    PolyMesh mesh;
    SubdivisionOptions options;
};

Cage readCage(const std::filesystem::path& path) {
    Cage cage{readObj(path).mesh, {}};
    std::vector<MeshWarning> warnings;
    repairTopology(cage.mesh, warnings);
    const std::string name = path.filename().string();
    cage.options.scheme = name.starts_with("loop") ? SubdivisionScheme::loop
        : name.starts_with("bilinear")             ? SubdivisionScheme::bilinear
                                                   : SubdivisionScheme::catmullClark;
    cage.options.boundary = BoundaryRule::edgeOnly;
    cage.options = withTags(cage.options, cage.mesh.tags);
    return cage;
}

/// Points in cells, so that near ones are found at once.
class PointSet {
public:
    PointSet(const std::vector<glm::dvec3>& points, double reach) : points_(points), reach_(reach) {
        for (std::size_t i = 0; i < points.size(); ++i) cells_[key(cell(points[i]))].push_back(i);
    }
    /// All points within reach.
    std::vector<std::size_t> near(const glm::dvec3& p) const {
        std::vector<std::size_t> found;
        const auto c = cell(p);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (const auto it = cells_.find(key(c + glm::i64vec3(x, y, z))); it != cells_.end())
                        for (const auto i : it->second)
                            if (glm::distance(points_[i], p) <= reach_) found.push_back(i);
        return found;
    }

private:
    glm::i64vec3 cell(const glm::dvec3& p) const { return glm::i64vec3(glm::floor(p / reach_)); }
    static std::size_t key(const glm::i64vec3& c) {
        return static_cast<std::size_t>(c.x * 73856093 ^ c.y * 19349663 ^ c.z * 83492791);
    }
    std::vector<glm::dvec3> points_;
    double reach_;
    std::unordered_map<std::size_t, std::vector<std::size_t>> cells_;
};

double diagonal(const std::vector<glm::dvec3>& points) {
    Bounds bounds;
    for (const auto& p : points) bounds.add(p);
    return bounds.diagonal();
}

/// Positions and normals of every triangle corner.
struct Corners {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
};
Corners cornersOf(const TriMesh& mesh) {
    Corners corners;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        corners.positions.push_back(glm::dvec3(mesh.positions[mesh.indices[i]]) + mesh.pivot);
        if (!mesh.normalIndices.empty()) corners.normals.push_back(mesh.normals[mesh.normalIndices[i]]);
        if (!mesh.uvIndices.empty()) corners.uvs.push_back(mesh.uvs[mesh.uvIndices[i]]);
    }
    return corners;
}

/// Edges of triangles that an odd number of triangles use, where points are the same only if every bit is.
std::size_t openEdges(const TriMesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> numbers;
    std::vector<std::uint32_t> number;
    for (const auto& p : mesh.positions)
        number.push_back(
            numbers.emplace(std::array{p.x, p.y, p.z}, static_cast<std::uint32_t>(numbers.size())).first->second);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const auto a = number[mesh.indices[i]], b = number[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]];
        ++uses[std::minmax(a, b)];
    }
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second % 2 == 1; }));
}

/// Points of the triangles' rims, in world units.
std::vector<glm::dvec3> rimPoints(const TriMesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> numbers;
    std::vector<std::uint32_t> number;
    for (const auto& p : mesh.positions)
        number.push_back(
            numbers.emplace(std::array{p.x, p.y, p.z}, static_cast<std::uint32_t>(numbers.size())).first->second);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, std::array<std::uint32_t, 2>>> uses;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const auto a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
        auto& use = uses[std::minmax(number[a], number[b])];
        ++use.first;
        use.second = {a, b};
    }
    std::vector<glm::dvec3> points;
    for (const auto& [edge, use] : uses)
        if (use.first == 1)
            for (const auto i : use.second) points.push_back(glm::dvec3(mesh.positions[i]) + mesh.pivot);
    return points;
}

class Shapes : public testing::Test {
protected:
    void SetUp() override {
        if (dataFolder().empty()) GTEST_SKIP() << "LIMN_TEST_DATA names no folder of test data";
    }
};

TEST_F(Shapes, areFiniteAndWithoutCracks) {
    for (const auto& path : shapes("osd_shapes")) {
        Cage cage = readCage(path);
        cage.options.level = 3;
        TriMesh mesh, safe;
        try {
            mesh = subdivide(cage.mesh, cage.options, {true, true, false}, path.string());
            cage.options.safe = true;
            safe = subdivide(cage.mesh, cage.options, {true, true, false}, path.string());
        } catch (const Error& error) {
            // Only shapes whose rule leaves nothing may come to nothing.
            EXPECT_EQ(cage.options.boundary, BoundaryRule::none) << path << error.message;
            continue;
        }
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const auto& p = mesh.positions[mesh.indices[i]];
            const auto& n = mesh.normals[mesh.normalIndices[i]];
            ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << path;
            ASSERT_NEAR(glm::length(n), 1, 1e-5) << path;
        }
        // As many as uniform refinement leaves open, which shares every point; where it does not know a vertex's limit
        // (two faces), as many as the cage's open edges were cut into.
        // Faces that meet themselves are cut, and edges of three faces and more are open or not as it happens: nothing
        // to count there.
        if (path.filename() == "catmark_nonman_edges.obj") continue;
        const std::size_t open = openEdges(mesh);
        if (open != openEdges(safe)) { EXPECT_EQ(open, analyseTopology(cage.mesh).boundaryEdges * 8) << path; }
    }
}

TEST_F(Shapes, lieOnTheLimitSurface) {
    std::size_t total = 0;
    for (const auto& path : shapes("osd_shapes")) {
        Cage cage = readCage(path);
        const auto regular = [&](std::size_t sides) {
            return std::adjacent_find(cage.mesh.faceStart.begin(), cage.mesh.faceStart.end(), [&](auto a, auto b) {
                return b - a != sides;
            }) == cage.mesh.faceStart.end();
        };
        // Faces of other sizes are cut in other places; the next test looks at those.
        if (!regular(cage.options.scheme == SubdivisionScheme::loop ? 3 : 4)
            || cage.options.boundary == BoundaryRule::none)
            continue;
        // Uniform refinement, the oracle, goes six levels deep: creases must have gone smooth by then.
        const auto outlasts = [](float sharpness) { return sharpness > 6 && sharpness < kInfiniteSharpness; };
        if (std::any_of(cage.mesh.tags.creases.begin(), cage.mesh.tags.creases.end(),
                [&](const auto& c) { return outlasts(c.sharpness); }))
            continue;
        cage.options.level = 3;
        const TriMesh mesh = subdivide(cage.mesh, cage.options, {true, true, false}, path.string());
        const Corners bfr = cornersOf(mesh);
        cage.options.safe = true;
        const Corners safe = cornersOf(subdivide(cage.mesh, cage.options, {true, true, false}, path.string()));
        // Where an infinitely sharp crease ends in a dart, uniform refinement halves its own error with each level:
        // 1e-4 is left of it after six (7e-4 after three).
        std::map<std::uint32_t, int> ends;
        for (const auto& crease : cage.mesh.tags.creases)
            if (crease.sharpness >= kInfiniteSharpness) {
                ++ends[crease.a];
                ++ends[crease.b];
            }
        const bool dart = std::any_of(ends.begin(), ends.end(), [](const auto& end) { return end.second == 1; });
        const double reach = (dart ? 2e-4 : 1e-5) * diagonal(safe.positions);
        const PointSet bfrPoints(bfr.positions, reach), safePoints(safe.positions, reach);
        // Where a surface has no one normal, both ways have a rule of their own: rims' corners, infinite creases and
        // corners.
        std::vector<glm::dvec3> singular = rimPoints(mesh);
        for (const auto& corner : cage.mesh.tags.corners)
            if (corner.sharpness >= kInfiniteSharpness) singular.push_back(cage.mesh.positions[corner.vertex]);
        const PointSet singularPoints(singular, reach);
        // Non-manifold cages have no oracle for normals: OpenSubdiv 3.5's limit tangents must not be asked of them.
        const TopologyReport topology = analyseTopology(cage.mesh);
        const bool oneNormal = cage.options.scheme != SubdivisionScheme::bilinear && topology.nonManifoldVertices == 0
            && topology.nonManifoldEdges == 0;
        const double halfDegree = std::cos((dart ? 5 : 0.5) * std::acos(-1.0) / 180);
        std::size_t astray = 0, bent = 0, uvAstray = 0, normals = 0;
        for (const auto& p : bfr.positions) astray += safePoints.near(p).empty();
        for (std::size_t i = 0; i < safe.positions.size(); ++i) {
            const auto near = bfrPoints.near(safe.positions[i]);
            astray += near.empty();
            if (near.empty()) continue;
            const bool crease = std::any_of(near.begin(), near.end(),
                [&](auto j) { return glm::dot(bfr.normals[near[0]], bfr.normals[j]) < halfDegree; });
            if (oneNormal && !crease && singularPoints.near(safe.positions[i]).empty()) {
                bent += glm::dot(safe.normals[i], bfr.normals[near[0]]) < static_cast<float>(halfDegree);
                ++normals;
            }
            if (!safe.uvs.empty() && !bfr.uvs.empty())
                uvAstray += std::none_of(
                    near.begin(), near.end(), [&](auto j) { return glm::distance(safe.uvs[i], bfr.uvs[j]) < 1e-5f; });
        }
        total += normals;
        EXPECT_EQ(astray, 0u) << "points: " << path << " of " << safe.positions.size();
        EXPECT_EQ(uvAstray, 0u) << "uvs: " << path << " of " << safe.positions.size();
        EXPECT_EQ(bent, 0u) << "normals: " << path << " of " << safe.positions.size();
    }
    EXPECT_GT(total, 500000u) << "normals that were compared";
}

TEST_F(Shapes, refineToWhatHbrMade) {
    int checked = 0;
    for (const auto& path : shapes("osd_hbr_baseline")) {
        const std::string stem = path.stem().string(), name = stem.substr(0, stem.find("_level"));
        const int level = stem.back() == '0' ? 1 : 3;
        // By design: OpenSubdiv's Chaikin rule is not Hbr's after the first levels, and hierarchical edits are not
        // applied.
        if (stem == "catmark_chaikin1_level2" || stem == "loop_chaikin1_level2"
            || name.find("hedit") != std::string::npos)
            continue;
        Cage cage = readCage(dataFolder() / "osd_shapes" / (name + ".obj"));
        cage.options.level = level;
        cage.options.limit = false;
        const PolyMesh refined = refineUniformly(cage.mesh, cage.options, false);
        const PolyMesh baseline = readObj(path).mesh;
        // The flap's coordinates have more digits than the six that the file prints.
        const double reach = (name == "catmark_flap" ? 2e-6 : 1e-6) * diagonal(baseline.positions);
        const PointSet ours(refined.positions, reach), theirs(baseline.positions, reach);
        std::size_t astray = 0;
        for (const auto& p : refined.positions) astray += theirs.near(p).empty();
        for (const auto& p : baseline.positions) astray += ours.near(p).empty();
        EXPECT_EQ(astray, 0u) << stem << ": of " << refined.positions.size() << " and " << baseline.positions.size();
        ++checked;
    }
    EXPECT_GT(checked, 50);
}

// Bfr 3.5 crashed on a fuzzed file of this kind: creases where several fans of faces meet in one vertex.
TEST(Subdivision, creasesOnNonManifoldPiecesAreTakenTheSafeWay) {
    // A book of three pages, each of two by two faces, with semi-sharp creases along and across the spine.
    std::string book = "v 0 0 0\nv 0 1 0\nv 0 2 0\n", faces;
    for (int page = 0; page < 3; ++page) {
        const double a = page * 2.1;
        const int first = 4 + page * 6;
        for (int column = 1; column <= 2; ++column)
            for (int row = 0; row < 3; ++row)
                book += fmt::format("v {} {} {}\n", column * std::cos(a), row, column * std::sin(a));
        for (int row = 0; row < 2; ++row) {
            faces += fmt::format("f {} {} {} {}\n", row + 1, first + row, first + row + 1, row + 2);
            faces += fmt::format("f {} {} {} {}\n", first + row, first + 3 + row, first + 4 + row, first + row + 1);
        }
        faces += fmt::format("t crease 2/1/0 1 {} 2.5\nt crease 2/1/0 {} {} 1.3\n", first, first, first + 3);
    }
    ObjFile file = parseObj(book + faces, "book", 1);
    SubdivisionReport report;
    const TriMesh out = subdivide(file.mesh, withTags({}, file.mesh.tags), {true, false, false}, "book", &report);
    EXPECT_EQ(report.safeComponents, 1u);
    EXPECT_GT(out.triangleCount(), 50u);
    for (const auto& p : out.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
}

TEST(Subdivision, coloursAreBilinearBetweenTheCagesVertices) {
    // A quad and a triangle beside it. However it is subdivided, a corner of the cage keeps its colour, edges blend
    // their ends', and the middle of the quad has the mean of its four.
    PolyMesh cage = parseObj(
        "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 2 0 0 0 0 0\nf 1 2 3 4\nf 2 5 3\n", "cage")
                        .mesh;
    const auto colorsAt = [](const TriMesh& mesh, const glm::dvec3& place) {
        std::vector<glm::vec3> found;
        for (std::size_t i = 0; i < mesh.indices.size(); ++i)
            if (glm::distance(glm::dvec3(mesh.positions[mesh.indices[i]]) + mesh.pivot, place) < 1e-5)
                found.push_back(mesh.colors[mesh.colorIndices.empty() ? mesh.indices[i] : mesh.colorIndices[i]]);
        return found;
    };
    for (const auto& [what, options, unified] :
        std::initializer_list<std::tuple<const char*, SubdivisionOptions, bool>>{
            {"Bfr", {.scheme = SubdivisionScheme::bilinear}, false},
            {"uniform", {.scheme = SubdivisionScheme::bilinear, .limit = false}, false},
            {"unified", {.scheme = SubdivisionScheme::bilinear}, true}}) {
        const TriMesh mesh = subdivide(cage, options, {false, false, unified, true}, "cage");
        const std::pair<glm::dvec3, glm::vec3> expected[] = {{{0, 0, 0}, {1, 0, 0}}, {{1, 1, 0}, {0, 0, 1}},
            {{0.5, 0, 0}, {0.5f, 0.5f, 0}}, {{0.5, 0.5, 0}, {0.5f, 0.5f, 0.5f}}, {{1.5, 0, 0}, {0, 0.5f, 0}}};
        for (const auto& [place, color] : expected) {
            const auto found = colorsAt(mesh, place);
            ASSERT_FALSE(found.empty()) << what;
            for (const auto& c : found)
                EXPECT_LT(glm::distance(c, color), 1e-6f) << what << ' ' << place.x << ' ' << place.y;
        }
    }
    // Smooth surfaces move, but their colours stay between those of the cage.
    const TriMesh smooth = subdivide(cage, {}, {true, true, false, true}, "cage");
    ASSERT_EQ(smooth.colorIndices.size(), smooth.indices.size());
    for (const auto& c : smooth.colors)
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(c, glm::vec3(-1e-6f)))
            && glm::all(glm::lessThanEqual(c, glm::vec3(1 + 1e-6f))));
}

TEST_F(Shapes, modelsThatCorruptBfrAreTakenTheSafeWay) {
    // Run this one under valgrind and with sanitizers: Bfr 3.5 writes out of bounds on some of these. Without repair
    // too, which drops the back sides that make a plant's leaves closed pieces with vertices of two faces.
    std::size_t safe = 0;
    for (const char* name : {"littlePlant/littlePlant.obj", "pedestrianRailing1/pedestrianRailing1.obj"}) {
        PolyMesh mesh = readObj(dataFolder() / "debian_sh3d_cc0" / name).mesh;
        for (const bool repaired : {false, true}) {
            std::vector<MeshWarning> warnings;
            if (repaired) repairTopology(mesh, warnings);
            SubdivisionReport report;
            const TriMesh out = subdivide(mesh, {}, {true, true, false}, name, &report);
            safe += report.safeComponents;
            for (const auto i : out.indices)
                ASSERT_TRUE(std::isfinite(out.positions[i].x + out.positions[i].y + out.positions[i].z)) << name;
        }
    }
    EXPECT_GT(safe, 0u) << "else nothing was put to the test";
}

TEST(Subdivision, mendsMissingNormalsAndNoOthers) {
    const std::string cube =
                          "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
                      // A face without area, whose surface has no normal anywhere.
        point = "v 5 5 5\nv 5 5 5\nv 5 5 5\nv 5 5 5\nf 9 10 11 12\n";
    SubdivisionOptions options;
    options.level = 2;
    const auto made = [&](const std::string& text) {
        ObjFile file = parseObj(text, "m.obj");
        repairTopology(file.mesh, file.warnings);
        return subdivide(file.mesh, options, {.normals = true}, "m.obj");
    };
    const TriMesh alone = made(cube), both = made(cube + point);
    ASSERT_EQ(both.triangleCount(), alone.triangleCount()) << "triangles without area are dropped";
    const auto normalOf = [](const TriMesh& mesh, std::size_t corner) {
        return mesh.normals[mesh.normalIndices.empty() ? mesh.indices[corner] : mesh.normalIndices[corner]];
    };
    for (std::size_t corner = 0; corner < 3 * alone.triangleCount(); ++corner)
        ASSERT_LT(glm::length(normalOf(both, corner) - normalOf(alone, corner)), 1e-5f)
            << "another pivot rounds otherwise";
}

}  // namespace
}  // namespace limn
