// Materials as many programs write them, and files under other spellings of their names.

#include "formats/mtl.h"
#include "base/file.h"
#include "formats/find_file.h"
#include "formats/obj.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

namespace limn {
namespace {

namespace fs = std::filesystem;

/// A folder with the files of a model.
class Mtl : public testing::Test {
protected:
    Mtl() {
        for (const char* file : {"wood.png", "Leaf.PNG", "wood grain.png", "-dash.png", "#hash.png", "10 steps.png",
                 "textures/Brick.JPG", "textures/tile.png", "other/tile.png", "'quoted.png"})
            replaceFile(folder_ / file, "x");
    }
    ~Mtl() override { fs::remove_all(folder_); }

    MtlFile parse(const std::string& text) const { return parseMtl(text, folder_); }
    /// The one material of a library, of which nothing was ignored.
    Material one(const std::string& text) const {
        const MtlFile file = parse("newmtl m\n" + text);
        for (const auto& warning : file.warnings) ADD_FAILURE() << text << ": " << warning.kind;
        return file.materials.at(0);
    }
    /// The one warning about a material.
    MeshWarning warning(const std::string& text) const {
        const MtlFile file = parse("newmtl m\n" + text);
        EXPECT_EQ(file.warnings.size(), 1u) << text;
        return file.warnings.empty() ? MeshWarning{} : file.warnings[0];
    }
    std::string texture(const std::string& statement) const {
        const std::string path = parse("newmtl m\n" + statement).materials.at(0).texture;
        return path.empty() ? path : fs::path(path).lexically_relative(folder_).lexically_normal().string();
    }

    fs::path folder_ = fs::temp_directory_path() / fmt::format("limn-mtl-{}", ::getpid());
};

TEST_F(Mtl, readsColoursAndHighlights) {
    const MtlFile file =
        parse("\xEF\xBB\xBFnewmtl red paint\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 80\nnewmtl grey\nKd 0.5\nNs 80\n");
    ASSERT_EQ(file.materials.size(), 2u);
    EXPECT_TRUE(file.warnings.empty());
    EXPECT_EQ(file.materials[0].name, "red paint");
    EXPECT_EQ(file.materials[0].color, (Color{1, 0, 0}));
    EXPECT_EQ(file.materials[0].shininess, 80);
    EXPECT_EQ(file.materials[1].color, (Color{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(file.materials[1].shininess, 0) << "no highlight without a specular colour";
}

TEST_F(Mtl, readsKeywordsInAnyCase) {
    const MtlFile file = parse("NEWMTL a\nkd 1 0 0\nMAP_KD wood.png\nnewMtl b\nKD 0 1 0\nmap_D wood.png\n");
    ASSERT_EQ(file.materials.size(), 2u);
    EXPECT_EQ(file.materials[0].color, (Color{1, 0, 0}));
    EXPECT_FALSE(file.materials[0].texture.empty());
    EXPECT_EQ(file.materials[1].color, (Color{0, 1, 0}));
    EXPECT_FALSE(file.materials[1].cutout.empty());
}

TEST_F(Mtl, placesImagesAsTheirOptionsSay) {
    EXPECT_EQ(one("map_Kd -s 3 2 1 wood.png").textureScale, glm::dvec2(3, 2));
    EXPECT_EQ(one("map_Kd -s 3 wood.png").textureScale, glm::dvec2(3, 3)) << "one number for both ways";
    EXPECT_EQ(one("map_Kd -o 0.5 0.25 wood.png").textureOffset, glm::dvec2(0.5, 0.25));
    EXPECT_EQ(one("map_Kd -o 0.5 wood.png").textureOffset, glm::dvec2(0.5, 0));
    EXPECT_FALSE(one("map_Kd -CLAMP ON wood.png").textureRepeats);
    EXPECT_TRUE(one("map_Kd -clamp off wood.png").textureRepeats);
    const Material both = one("map_Kd -s 2 2 2 -o .5 0 0 wood.png\nmap_d -o .5 0 0 -s 2 2 2 wood.png");
    EXPECT_EQ(both.textureScale, glm::dvec2(2, 2));
    EXPECT_EQ(one("map_d -s 2 wood.png").textureScale, glm::dvec2(2, 2));
    EXPECT_NE(warning("map_Kd wood.png\nmap_d -s 2 2 2 wood.png").kind.find("taken as map_Kd's"), std::string::npos);
    EXPECT_EQ(one("map_d -imfchan m wood.png").cutout, (folder_ / "wood.png").string());
}

TEST_F(Mtl, namesEveryOptionAndStatementThatItIgnores) {
    for (const char* option : {"-bm 0.5", "-mm 0 1", "-blendu off", "-blendv on", "-texres 512", "-t 1 1 1", "-boost 2",
             "-cc on", "-imfchan r"}) {
        const auto found = warning(fmt::format("map_Kd {} wood.png", option));
        EXPECT_NE(found.kind.find(std::string(option).substr(0, 3)), std::string::npos) << option;
        EXPECT_EQ(found.firstLine, 2);
    }
    for (const char* statement :
        {"map_Ka wood.png", "map_Bump wood.png", "bump wood.png", "refl wood.png", "map_Tr wood.png", "norm wood.png",
            "map_Kd", "Ka 1 1 1", "Ni 1.5", "illum 2", "Ke 1 0 0", "Pr 0.5", "nonsense 1", "Kd spectral a.rfl 1"})
        EXPECT_NE(
            warning(statement).kind.find("ignored") + warning(statement).kind.find("skipped"), 2 * std::string::npos)
            << statement;
    const auto twice = warning("Ka 1 1 1\nillum 2\nnewmtl b\nKa 1 1 1");
    EXPECT_EQ(twice.count, 3u) << "all of these in one line";
    EXPECT_NE(twice.kind.find("Ka, illum"), std::string::npos) << twice.kind;
    EXPECT_NE(parse("Kd 1 0 0\nnewmtl a\n").warnings.at(0).kind.find("before the first newmtl"), std::string::npos);
}

TEST_F(Mtl, takesColoursAsTheyAreMeant) {
    EXPECT_EQ(one("map_Kd wood.png").color, (Color{1, 1, 1})) << "an image alone is not tinted";
    EXPECT_EQ(one("Kd 0 0 0\nmap_Kd wood.png").color, (Color{1, 1, 1})) << "nor black";
    EXPECT_EQ(one("Kd 0.5 1 1\nmap_Kd wood.png").color, (Color{0.5f, 1, 1}));
    EXPECT_EQ(one("Kd 0 0 0").color, (Color{0, 0, 0}));
    EXPECT_EQ(one("").color, kPaperGrey);
    EXPECT_EQ(one("Kd 1.0000001 0 -1").color, (Color{1, 0, 0})) << "what rounding makes";
    const MtlFile bytes = parse("newmtl m\nKd 204 51 0\n");
    EXPECT_EQ(bytes.materials[0].color, (Color{0.8f, 0.2f, 0}));
    EXPECT_NE(bytes.warnings.at(0).kind.find("0 to 255"), std::string::npos);
    // The white point of D65, and Rec.709's red, whose Y is 0.2126.
    const Color white = one("Kd xyz 0.9505 1 1.089").color, red = one("Kd xyz 0.4124 0.2126 0.0193").color;
    for (const float c : {white.r, white.g, white.b, red.r}) EXPECT_NEAR(c, 1, 2e-3);
    EXPECT_NEAR(red.g, 0, 1e-3);
    EXPECT_EQ(parse("newmtl m\nKd spectral a.rfl\n").materials[0].color, kPaperGrey);
}

TEST_F(Mtl, saysWhatItCannotShowThrough) {
    EXPECT_NE(warning("d 0.3").kind.find("material 'm' is see-through (d 0.3); drawn solid"), std::string::npos);
    EXPECT_NE(warning("d -halo 0.3").kind.find("see-through"), std::string::npos);
    EXPECT_NE(warning("Tr 0.7").kind.find("(Tr 0.7)"), std::string::npos);
    EXPECT_EQ(warning("Tr 0.7\nKd 1 1 1").firstLine, 2);
    EXPECT_NE(warning("Tr 1").kind.find("drawn solid"), std::string::npos) << "as scanners write what is solid";
    EXPECT_TRUE(parse("newmtl m\nTr 1\n").invisible.empty());
    EXPECT_EQ(parse("newmtl m\nd 0\n").invisible, std::vector<std::string>{"m"});
    EXPECT_EQ(parse("newmtl m\nd 0.0\nTr 1\n").invisible, std::vector<std::string>{"m"});
    for (const char* solid : {"d 1", "Tr 0", "d 1\nTr 1", "d 0\nmap_d wood.png"}) {
        one(solid);
        EXPECT_TRUE(parse(std::string("newmtl m\n") + solid).invisible.empty()) << solid;
    }
}

TEST_F(Mtl, findsImagesUnderTheNamesThatProgramsWrite) {
    const std::pair<const char*, const char*> same[] = {
        {"wood.png", "wood.png"},
        {"wood grain.png", "wood grain.png"},
        {".\\wood.png", "wood.png"},
        {"textures\\tile.png", "textures/tile.png"},
        {"textures\\\\tile.png", "textures/tile.png"},
        {"\"wood.png\"", "wood.png"},
        {"'wood grain.png'", "wood grain.png"},
        {"-dash.png", "-dash.png"},
        {"#hash.png", "#hash.png"},
        {"-s 1 1 1 10 steps.png", "10 steps.png"},
        {"10 steps.png", "10 steps.png"},
        {"'quoted.png", "'quoted.png"},
    };
    for (const auto& [written, file] : same) {
        EXPECT_EQ(texture(fmt::format("map_Kd {}", written)), file) << written;
        EXPECT_TRUE(parse(fmt::format("newmtl m\nmap_Kd {}", written)).warnings.empty()) << written;
    }
    const std::pair<const char*, const char*> elsewhere[] = {
        {"leaf.png", "Leaf.PNG"},
        {"textures/brick.jpg", "textures/Brick.JPG"},
        {"C:\\Users\\me\\Brick.JPG", "textures/Brick.JPG"},
        {"/home/me/wood.png", "wood.png"},
        {"~/wood.png", "wood.png"},
        {"gone\\WOOD.PNG", "wood.png"},
    };
    for (const auto& [written, file] : elsewhere) {
        EXPECT_EQ(texture(fmt::format("map_Kd {}", written)), file) << written;
        EXPECT_NE(warning(fmt::format("map_Kd {}", written)).kind.find(fmt::format("is found as '{}'", file)),
            std::string::npos)
            << written;
    }
    // Two that are called so: which is meant cannot be known.
    const auto two = warning("map_Kd C:\\tile.png");
    EXPECT_NE(two.kind.find("'other/tile.png' or 'textures/tile.png'"), std::string::npos) << two.kind;
    EXPECT_NE(warning("map_Kd wod.png").kind.find("did you mean 'wood.png'?"), std::string::npos);
    EXPECT_EQ(warning("map_Kd entirely_different").kind, "texture 'entirely_different' is missing; drawn without");
}

TEST_F(Mtl, findsHomeAndAbsoluteFolders) {
    const std::string home = folder_.string();
    const char* before = std::getenv("HOME");
    const std::string kept = before ? before : "";
    ::setenv("HOME", home.c_str(), 1);
    EXPECT_EQ(findNamedFile("~/textures/Brick.JPG", "/").path, folder_ / "textures/Brick.JPG");
    before ? ::setenv("HOME", kept.c_str(), 1) : ::unsetenv("HOME");
    EXPECT_EQ(findNamedFile((folder_ / "wood.png").string(), "/nowhere").path, folder_ / "wood.png");
}

TEST_F(Mtl, librariesGoToTheFacesThatMeanThem) {
    const auto read = [&](const std::string& obj, const std::string& mtl, std::vector<MeshWarning>& warnings) {
        replaceFile(folder_ / "My Model.mtl", mtl);
        PolyMesh mesh = parseObj("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + obj, "m.obj").mesh;
        const auto materials = readMaterials(folder_ / "m.obj", mesh, warnings);
        return std::pair(std::move(mesh), materials);
    };
    std::vector<MeshWarning> warnings;
    auto [all, only] = read("mtllib my model.MTL\nf 1 2 3\n", "newmtl brick\nKd 1 0 0\n", warnings);
    ASSERT_EQ(only.size(), 1u);
    EXPECT_EQ(all.materialNames, std::vector<std::string>{"brick"});
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].kind.find("is found as 'My Model.mtl'"), std::string::npos) << warnings[0].kind;
    EXPECT_NE(warnings[1].kind.find("all take the library's only one, 'brick'"), std::string::npos);

    // Several names: each is read, also where the last one alone would be found by its name.
    replaceFile(folder_ / "a.mtl", "newmtl a\n");
    replaceFile(folder_ / "sub/b.mtl", "newmtl b\n");
    PolyMesh two = parseObj("mtllib ./a.mtl ./b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "m.obj").mesh;
    EXPECT_EQ(readMaterials(folder_ / "m.obj", two, warnings).size(), 2u);
    warnings.clear();
    auto [shown, materials] = read("mtllib My Model.mtl\nusemtl a\nf 1 2 3\nusemtl hull\nf 1 2 3\nf 3 2 1\n",
        "newmtl a\nKa 1 1 1\nnewmtl hull\nd 0\n", warnings);
    EXPECT_EQ(shown.faceCount(), 1u);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(warnings[0].file, (folder_ / "My Model.mtl").string()) << "what a library says is the library's";
    EXPECT_EQ(warnings[0].firstLine, 2);
    EXPECT_EQ(warnings[1].count, 2u);
    EXPECT_NE(warnings[1].kind.find("(d 0); not drawn"), std::string::npos);
}

}  // namespace
}  // namespace limn
