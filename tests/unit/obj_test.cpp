#include "formats/obj.h"
#include "base/error.h"
#include "mesh/topology.h"
#include "mesh/tri_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace limn {
namespace {

ObjFile parse(std::string_view text, int chunks = 0) { return parseObj(text, "test.obj", chunks); }
constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

bool warned(const ObjFile& file, std::string_view words) {
    for (const auto& warning : file.warnings)
        if (warning.kind.find(words) != std::string::npos) return true;
    return false;
}

TEST(Obj, readsWhatRealFilesContain) {
    const auto file = parse(
        "\xEF\xBB\xBF# made\r\nmtllib a b.mtl\r\nv 0 0 0 1\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 \\\r\n0\r\nvt 0 0\r\nvn 0 0 "
        "1\r\nusemtl two words\r\no part\r\ns 1\r\nf 1/1/1 2//1 -2/1 -1\r\n");
    EXPECT_TRUE(file.warnings.empty());
    ASSERT_EQ(file.mesh.faceCount(), 1u);
    EXPECT_EQ(file.mesh.cornerPosition, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(file.mesh.cornerUv, (std::vector<std::int32_t>{0, -1, 0, -1}));
    EXPECT_EQ(file.mesh.cornerNormal, (std::vector<std::int32_t>{0, 0, -1, -1}));
    EXPECT_EQ(file.mesh.materialNames.at(file.mesh.faceMaterial[0]), "two words");
    EXPECT_EQ(file.mesh.materialLibraries.at(0), "a b.mtl");
    EXPECT_EQ(file.mesh.faceSmoothing[0], 1u);
}

TEST(Obj, mendsWithOneWarningPerKind) {
    const auto file = parse(std::string(kSquare) + "f 1 2 3\nf 1 2 9\nf 1 2 8\nf 1 2\nf 1 1 2 3\nf a b c\n"
        "v nan 0 0\nf 1 2 5\nf 1 2 3 4\nf 2 3 4\nbogus 1\nf 1 3 4\nf 4 3 2 1\n");
    EXPECT_EQ(file.mesh.faceCount(), 6u);
    EXPECT_TRUE(warned(file, "vertex that does not exist"));
    EXPECT_TRUE(warned(file, "fewer than three"));
    EXPECT_TRUE(warned(file, "repeats a vertex"));
    EXPECT_TRUE(warned(file, "no index"));
    EXPECT_TRUE(warned(file, "no finite place"));
    EXPECT_TRUE(warned(file, "does not know"));
    for (const auto& warning : file.warnings)
        if (warning.kind.find("does not exist") != std::string::npos) {
            EXPECT_EQ(warning.count, 2u);
            EXPECT_EQ(warning.firstLine, 6);
        }
}

TEST(Obj, readsColoursOfVertices) {
    const std::string text = "v 0 0 0\nv 1 0 0 1 0 0.5\nv 1 1 0 0.5\nv 0 1 0 0 1 0 1\nf 1 2 3 4\n";
    for (const int chunks : {1, 2, 4}) {
        const auto file = parse(text, chunks);
        EXPECT_TRUE(file.warnings.empty());
        ASSERT_EQ(file.mesh.colors.size(), 4u);
        EXPECT_EQ(file.mesh.colors[0], glm::vec3(1)) << "white where there is none";
        EXPECT_EQ(file.mesh.colors[1].r, 1);
        EXPECT_NEAR(file.mesh.colors[1].b, 0.2140411, 1e-6) << "0.5 display-encoded";
        EXPECT_EQ(file.mesh.colors[2], glm::vec3(1)) << "one number is a weight";
        EXPECT_EQ(file.mesh.colors[3], glm::vec3(0, 1, 0)) << "alpha is no colour";
    }
    EXPECT_TRUE(parse(kSquare + std::string("f 1 2 3 4\n")).mesh.colors.empty());

    const auto bytes = parse("v 0 0 0 255 0 51\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nf 1 2 3\n");
    EXPECT_TRUE(warned(bytes, "0 to 255"));
    EXPECT_EQ(bytes.mesh.colors[0].r, 1);
    EXPECT_NEAR(bytes.mesh.colors[0].b, 0.0331048, 1e-6);

    const auto bright = parse("v 0 0 0 1.25 0.5 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 0 0 0\nf 1 2 3\n");
    EXPECT_TRUE(warned(bright, "above 1; clamped"));
    EXPECT_EQ(bright.mesh.colors[0].r, 1);
    EXPECT_NEAR(bright.mesh.colors[1].r, 0.2140411, 1e-6) << "one bright colour does not darken the others";

    const auto odd = parse("v 0 0 0 nan 0.5 -1\nv 1 0 0 0.5 0.5\nv 1 1 0 blue\nf 1 2 3\n");
    EXPECT_TRUE(warned(odd, "clamped"));
    EXPECT_TRUE(warned(odd, "neither weight nor colour"));
    for (const auto& c : odd.mesh.colors) EXPECT_TRUE(c.r >= 0 && c.r <= 1 && c.b >= 0 && c.b <= 1);
}

TEST(Obj, refusesWhatCannotBeTrusted) {
    for (const char* text : {"", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 4 5 6\nf 1 2 3\n", "f 1 2 3\n"}) {
        try {
            parse(text);
            FAIL() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::badData);
            EXPECT_FALSE(error.remedy.empty());
        }
    }
}

TEST(Obj, cutAnywhereGivesTheSameMesh) {
    std::string text;
    for (int i = 0; i < 400; ++i)
        text += fmt::format(
            "v {} {} {}\nv {} 1 \\\n 2\nvt {} 0\nv 0 {} 1\nusemtl m{}\ng part{}\nf -3/-1 -2/-1 -1/-1\nf {} 2 \\\n3 4\n",
            i, i * 0.5, -i, i, i * 0.01, i + 1, i % 7, i % 5, i + 1);
    const auto whole = parse(text, 1);
    for (const int chunks : {2, 3, 17, 200}) {
        const auto cut = parse(text, chunks);
        EXPECT_EQ(cut.mesh.cornerPosition, whole.mesh.cornerPosition) << chunks;
        EXPECT_EQ(cut.mesh.cornerUv, whole.mesh.cornerUv) << chunks;
        EXPECT_EQ(cut.mesh.faceMaterial, whole.mesh.faceMaterial) << chunks;
        EXPECT_EQ(cut.mesh.facePart, whole.mesh.facePart) << chunks;
        EXPECT_EQ(cut.mesh.positions, whole.mesh.positions) << chunks;
    }
}

TEST(Obj, hostileTextNeverCrashes) {
    std::mt19937 random(7);
    const std::string good =
        std::string(kSquare) + "vt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nusemtl a\ng b\ns 1\nf 1 2 3 4\n";
    const std::string alphabet =
        "vftn 0123456789-/.e+\\\n\r\t#\"\xff"
        "nai";
    int survived = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = good;
        for (int k = 0; k < 1 + i % 9; ++k) {
            const auto at = random() % text.size();
            switch (random() % 3) {
                case 0: text[at] = alphabet[random() % alphabet.size()]; break;
                case 1: text.insert(at, 1, alphabet[random() % alphabet.size()]); break;
                default: text.erase(at, 1 + random() % 3);
            }
            if (text.empty()) text = "v";
        }
        try {
            const auto file = parse(text);
            for (const auto v : file.mesh.cornerPosition) ASSERT_LT(v, file.mesh.positions.size());
            const TriMesh mesh = buildTriMesh(file.mesh, {true, true, i % 2 == 0});
            for (const auto index : mesh.normalIndices) ASSERT_LT(index, mesh.normals.size());
            for (const auto index : mesh.uvIndices) ASSERT_LT(index, mesh.uvs.size());
            for (const auto index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
            for (const auto& n : mesh.normals) ASSERT_TRUE(std::isfinite(n.x + n.y + n.z));
            ++survived;
        } catch (const Error& error) { ASSERT_EQ(error.code, ExitCode::badData); }
    }
    EXPECT_GT(survived, 5000) << "most damage should be mended";
}

double area(const std::vector<glm::dvec3>& p, const std::vector<std::uint32_t>& triangles) {
    double sum = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        sum += glm::cross(p[triangles[t + 1]] - p[triangles[t]], p[triangles[t + 2]] - p[triangles[t]]).z / 2;
    return sum;
}

TEST(Polygon, concaveOnesAreFilledRight) {
    const std::vector<glm::dvec3> arrow{{0, 0, 0}, {2, 2, 0}, {0, 1, 0}, {-2, 2, 0}};
    EXPECT_NEAR(area(arrow, triangulatePolygon(arrow)), 2, 1e-12);
    // A comb with 300 corners: far more than fits a byte.
    std::vector<glm::dvec3> comb;
    for (int i = 0; i < 149; ++i) comb.emplace_back(i, i % 2 ? 1 : 0.1, 0);
    comb.emplace_back(148, -1, 0);
    comb.emplace_back(0, -1, 0);
    std::reverse(comb.begin(), comb.end());
    double expected = 0;
    for (std::size_t i = 0; i < comb.size(); ++i)
        expected += (comb[i].x * comb[(i + 1) % comb.size()].y - comb[(i + 1) % comb.size()].x * comb[i].y) / 2;
    const auto triangles = triangulatePolygon(comb);
    EXPECT_NEAR(area(comb, triangles), expected, 1e-9);
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        EXPECT_GE(area(comb, {triangles[t], triangles[t + 1], triangles[t + 2]}), 0) << "no triangle folds over";
}

TEST(TriMesh, buildsOnlyWhatIsAsked) {
    const auto file = parse(std::string(kSquare) + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
    const TriMesh bare = buildTriMesh(file.mesh, {});
    EXPECT_TRUE(bare.normals.empty() && bare.uvs.empty() && bare.triangleMaterial.empty() && bare.trianglePart.empty());
    EXPECT_EQ(bare.triangleCount(), 2u);
    const TriMesh full = buildTriMesh(file.mesh, {true, true, true});
    EXPECT_EQ(full.normals.size(), full.positions.size());
    EXPECT_EQ(full.uvs.size(), full.positions.size());
}

TEST(TriMesh, missingNormalsAreSmoothByAngleOrGroup) {
    // Two squares folded by 20 degrees are one smooth surface; by 90 degrees they are not.
    const auto fold = [](double degrees, const char* smoothing) {
        const double r = degrees * std::acos(-1.0) / 180;
        return fmt::format("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv {0} 0 {1}\nv {0} 1 {1}\n{2}f 1 2 3 4\nf 2 5 6 3\n",
            1 + std::cos(r), std::sin(r), smoothing);
    };
    const auto vertices = [&](double degrees, const char* smoothing) {
        return buildTriMesh(parse(fold(degrees, smoothing)).mesh, {true, false, true}).positions.size();
    };
    EXPECT_EQ(vertices(20, ""), 8u - 2u + 0u + 0u);  // shared along the fold…
    EXPECT_EQ(vertices(90, ""), 8u);                 // …or split
    EXPECT_EQ(vertices(90, "s 1\n"), 6u);
    EXPECT_EQ(vertices(20, "s off\n"), 8u);
}

TEST(TriMesh, numbersTrianglesByTheirLastVertexWithFewRepeats) {
    // A grid has half as many vertices as triangles: each can be the last one of a triangle.
    std::string text;
    constexpr int n = 40;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) text += fmt::format("v {} {} {}\n", x, y, (x * y) % 3);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            text += fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", y * (n + 1) + x + 1, y * (n + 1) + x + 2,
                (y + 1) * (n + 1) + x + 2, (y + 1) * (n + 1) + x + 1);
    const PolyMesh mesh = parse(text).mesh;
    const TriMesh made = buildTriMesh(mesh, {});
    ASSERT_EQ(made.triangleCount(), 2u * n * n);
    for (std::uint32_t t = 0; t < made.triangleCount(); ++t) ASSERT_EQ(made.indices[std::size_t{3} * t + 2], t);
    EXPECT_LE(made.positions.size(), made.triangleCount() + 4) << "the grid's corners";
}

TEST(TriMesh, farFromTheOriginKeepsItsShape) {
    const auto near = buildTriMesh(parse(kSquare + std::string("f 1 2 3 4\n")).mesh, {});
    const auto far = buildTriMesh(
        parse("v 1e8 1e8 0\nv 100000001 1e8 0\nv 100000001 100000001 0\nv 1e8 100000001 0\nf 1 2 3 4\n").mesh, {});
    EXPECT_EQ(near.positions, far.positions);
    EXPECT_EQ(far.pivot - near.pivot, glm::dvec3(1e8, 1e8, 0));
}

/// A cylinder of `sides` quads around, cut open along one line, whose ends lie in the same place.
std::string splitTube(int sides, const char* last = "") {
    std::string text;
    for (int s = 0; s <= sides; ++s) {
        const double turn = 2 * std::acos(-1.0) * (s % sides) / sides;
        text += fmt::format("v {0} 0 {1}\nv {0} 1 {1}\n", std::cos(turn), std::sin(turn));
    }
    for (int s = 0; s < sides; ++s)
        text +=
            fmt::format("{}f {} {} {} {}\n", s + 1 == sides ? last : "", 2 * s + 1, 2 * s + 2, 2 * s + 4, 2 * s + 3);
    return text;
}

TEST(Seams, thatLieInOnePlaceAreJoined) {
    PolyMesh tube = parse(splitTube(8)).mesh;
    EXPECT_EQ(analyseTopology(tube).boundaryEdges, 8u * 2 + 2);
    EXPECT_EQ(joinSeams(tube), 2u);
    EXPECT_EQ(analyseTopology(tube).boundaryEdges, 8u * 2);
    EXPECT_EQ(joinSeams(tube), 0u) << "once is enough";
    // -0 lies where 0 does.
    PolyMesh sheet = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv -0.0 0 0\nv 1 0 -0.0\nv 1 -1 0\nf 1 2 3\nf 5 4 6\n").mesh;
    EXPECT_EQ(joinSeams(sheet), 2u);
    // Parts that touch stay apart, and so do three sheets that meet in one line.
    PolyMesh parts = parse(splitTube(8, "o other\n")).mesh;
    EXPECT_EQ(joinSeams(parts), 0u);
    PolyMesh three = parse(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 -1 0\n"
        "f 1 2 3\nf 4 5 6\nf 7 8 9\n")
                         .mesh;
    EXPECT_EQ(joinSeams(three), 0u);
    // A face whose own sides lie in one place stays as it is: no face has a corner twice.
    PolyMesh own = parse("v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 3 4\n").mesh;
    EXPECT_EQ(joinSeams(own), 0u);
    // Creases follow their vertices.
    PolyMesh creased = parse(splitTube(4) + "t crease 2/1/0 8 9 3.0\n").mesh;
    ASSERT_EQ(creased.tags.creases.size(), 1u);
    EXPECT_EQ(joinSeams(creased), 2u);
    EXPECT_EQ(std::max(creased.tags.creases[0].a, creased.tags.creases[0].b), 1u) << "8 and 9 became 0 and 1";
}

TEST(Topology, countsVerticesOfSeveralFans) {
    const auto count = [](const std::string& faces) {
        return analyseTopology(parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\n" + faces).mesh)
            .nonManifoldVertices;
    };
    EXPECT_EQ(count("f 1 2 3\nf 1 3 4\n"), 0u) << "a fan";
    EXPECT_EQ(count("f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n"), 0u) << "a closed one";
    EXPECT_EQ(count("f 1 2 3\nf 1 4 5\n"), 1u) << "two";
    EXPECT_EQ(count("f 1 2 3\nf 1 3 2\nf 1 4 5\nf 1 5 4\n"), 1u) << "two closed ones";
    EXPECT_EQ(count("f 1 2 3\nf 1 3 4\nf 1 3 6\n"), 0u) << "three faces on one edge hang together";
    EXPECT_EQ(count("f 1 2 3\nf 3 4 1\n"), 0u) << "however they are wound";
    EXPECT_EQ(count("f 2 1 3\nf 1 3 4\n"), 0u);
}

TEST(Normals, thatPointAgainstTheirFacesAreTurned) {
    const auto square = [](const std::string& faces) {
        return parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 -1\n" + faces).mesh;
    };
    const auto upwards = [](const PolyMesh& mesh) {
        std::size_t count = 0;
        for (const auto n : mesh.cornerNormal) count += mesh.normals[static_cast<std::size_t>(n)].z > 0;
        return count;
    };
    std::vector<MeshWarning> warnings;
    PolyMesh sound = square("f 1//1 2//1 3//1 4//1\n");
    turnNormals(sound, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(sound.normals.size(), 2u) << "nothing is added where nothing is wrong";
    PolyMesh all = square("f 1//2 2//2 3//2 4//2\n");
    turnNormals(all, warnings);
    EXPECT_EQ(upwards(all), 4u);
    PolyMesh one = square("f 1//1 2//2 3//1 4//1\n");
    turnNormals(one, warnings);
    EXPECT_EQ(upwards(one), 4u);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(warnings[0].count, 4u);
    EXPECT_EQ(warnings[1].count, 1u);
    // A face wound against its neighbour is turned itself, for its normals are right.
    PolyMesh wound = square("f 1//1 2//1 3//1\nf 1//1 4//1 3//1\n");
    turnNormals(wound, warnings);
    EXPECT_EQ(upwards(wound), 6u);
    EXPECT_EQ(warnings.size(), 3u);
}

}  // namespace
}  // namespace limn
