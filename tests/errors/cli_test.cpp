// What goes wrong, as a person meets it: the real program, its exit code, one clear message, and nothing half-written.

#include "base/file.h"
#include "image/image.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

namespace limn::test {
namespace {

const std::string kConfig =
    "scene = \"scene.toml\"\n[image]\nsize = [64, 48]\nsamples = 1\n[output]\npath = \"out/picture.png\"\n";

/// A folder with a small scene and a config that draws it.
class Errors : public testing::Test {
protected:
    void SetUp() override {
        write("m.obj", boxObj({-1, -1, -1}, {1, 1, 1}));
        write("scene.toml", "[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n");
        write("config.toml", kConfig);
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder.path() / name) << text; }
    RunResult run(const std::string& arguments, const std::string& environment = "") {
        return runLimn(arguments, folder.path(), environment);
    }
    /// Files that a failed run must not leave.
    int temporaries() const {
        int count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
            count += entry.path().filename().string().starts_with(".limn-");
        return count;
    }
    void expect(const std::string& arguments, int code, const std::string& words) {
        const RunResult r = run(arguments);
        EXPECT_EQ(r.exitCode, code) << arguments << "\n" << r.err;
        EXPECT_NE(r.err.find(words), std::string::npos) << arguments << "\n" << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << "one message: " << r.err;
        EXPECT_TRUE(r.out.empty()) << "messages go to standard error";
        EXPECT_EQ(temporaries(), 0);
    }

    TemporaryFolder folder;
};

TEST_F(Errors, aBadFrameFailsAloneWhereTheOthersGoOn) {
    for (const int frame : {1, 2, 3}) write(fmt::format("m_{}.obj", frame), boxObj({-1, -1, -1}, {1, frame, 1}));
    write("m_1.obj", "v 0 0 0\nf 1 2 3\n");
    write("scene.toml", "[animation]\nframes = \"2-3\"\n[[mesh]]\nname = \"m\"\nfile = \"m_#.obj\"\n");
    // The bad one is first: what was begun for it must not come up again.
    const RunResult r = run("render config.toml --frames 1-3 --keep-going --output out/p_#.png");
    EXPECT_EQ(r.exitCode, 1) << r.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/p_1.png"));
    for (const char* name : {"out/p_2.png", "out/p_3.png"})
        EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << r.err;
}

TEST_F(Errors, aBadFileStopsNoFrameThatDoesNotUseIt) {
    for (const int frame : {1, 2, 3}) write(fmt::format("m_{}.obj", frame), boxObj({-1, -1, -1}, {1, frame, 1}));
    write("scene.toml", "[animation]\nframes = \"1-3\"\n[[mesh]]\nname = \"m\"\nfile = \"m_#.obj\"\n");
    for (const int bad : {1, 3}) {
        write(fmt::format("m_{}.obj", bad), "v 0 0 0\nf 1 2 3\n");
        EXPECT_EQ(run("render config.toml --frames 2 --output out/p_#.png").exitCode, 0);
        expect(fmt::format("render config.toml --frames {} --output out/p_#.png", bad), 65,
            fmt::format("m_{}.obj:2: 1 of 1 faces", bad));
    }
    // Where nothing can be read there is nothing to draw.
    write("m_2.obj", "v 0 0 0\nf 1 2 3\n");
    EXPECT_EQ(run("render config.toml --output out/p_#.png").exitCode, 65);
}

TEST_F(Errors, anImageThatFailsOnceFailsInEveryFrame) {
    write("m.obj", "vt 0 0\nvt 1 0\nvt 1 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n");
    write("bad.png", "this is no picture");
    write("scene.toml",
        "[animation]\nframes = \"1-2\"\n[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n[[material]]\nname = \"t\"\ntexture "
        "= "
        "\"bad.png\"\n[[instance]]\nmesh = \"m\"\nmaterial = \"t\"\n");
    const RunResult r = run("render config.toml --keep-going --output out/p_#.png");
    EXPECT_EQ(r.exitCode, 65) << r.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/p_1.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/p_2.png")) << "drawn without its texture";
}

TEST_F(Errors, aTransparentJpegIsDrawnAndSaid) {
    const RunResult jpeg = run("render config.toml --set image.background=transparent --output a.jpg");
    EXPECT_EQ(jpeg.exitCode, 0);
    EXPECT_NE(jpeg.err.find("'a.jpg' cannot be transparent"), std::string::npos) << jpeg.err;
    for (const char* sound : {"--set image.background=transparent --output a.png", "--output a.jpg"}) {
        const RunResult silent = run(std::string("render config.toml ") + sound);
        EXPECT_EQ(silent.err.find("transparent"), std::string::npos) << silent.err;
    }
}

TEST_F(Errors, aGoodConfigDraws) {
    const RunResult r = run("render config.toml");
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_NE(r.err.find("Saved: 'out/picture.png'"), std::string::npos) << r.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/picture.png"));
}

TEST_F(Errors, wordsAndNumbers) {
    write("typo.toml", kConfig + "[ao]\ntechnique = \"toon_ssao\"\nraduis = 1\n");
    expect("render typo.toml", 64, "typo.toml:9:1: unknown key 'raduis' in [ao] (toon_ssao); did you mean 'radius'?");
    write("technique.toml", kConfig + "[ao]\ntechnique = \"toon_sao\"\n");
    expect("render technique.toml", 64, "did you mean 'toon_ssao'?");
    write("range.toml", kConfig + "[shading]\ntechnique = \"toon\"\nbands = 99\n");
    expect("render range.toml", 64, "range.toml:9:9: 'bands' in [shading] (toon) is 99, but must be 2 to 16");
    write("section.toml", kConfig + "[shadng]\ntechnique = \"toon\"\n");
    expect("render section.toml", 64, "did you mean 'shading'?");
    write("syntax.toml", kConfig + "[ao\n");
    expect("render syntax.toml", 64, "syntax.toml:7:");
    write("aov.toml", kConfig + "aovs = [\"dept\"]\n");
    expect("render aov.toml", 64, "did you mean 'depth'?");
    write("noao.toml", kConfig + "aovs = [\"ambient_occlusion\"]\n");
    expect("render noao.toml", 64, "add a table [ao]");
    expect("render config.toml --set image.size=[0,4]", 64, "must be 1 to 65536");
    expect("render config.toml --camera nowhere", 64, "no camera 'nowhere'");
    expect("render config.toml --crop 1,2,3", 64, "X,Y,W,H");
    expect("render config.toml --crop 60,40,10,10", 64, "does not lie in the picture");
    expect("render config.toml --frames 1:5", 64, "list of frames");
    expect("render config.toml --frames 1-3", 64, "####");
    expect("render config.toml --output picture.bmp", 64, ".exr, .jpg, .pdf, .png, .svg or .tif");
    EXPECT_EQ(run("render config.toml --device nonsense").exitCode, 69) << "with a line for each device";
    expect("techniques nonsense", 64, "there is no technique");
}

TEST_F(Errors, allAtOnce) {
    write("many.toml",
        kConfig + "[ao]\ntechnique = \"toon_ssao\"\nraduis = 1\npoints = 0\n[[edges]]\ntechnique = \"lines\"\n");
    const RunResult r = run("check many.toml");
    EXPECT_EQ(r.exitCode, 64);
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 3) << r.err;
}

TEST_F(Errors, missingAndBrokenFiles) {
    expect("render nothing.toml", 66, "nothing.toml: cannot be read");
    expect("render nothing.obj", 66, "does not exist");
    write("lost.toml", "scene = \"lost_scene.toml\"\n");
    expect("render lost.toml", 66, "lost.toml:1:");
    write("lostmesh.toml", "[[mesh]]\nname = \"m\"\nfile = \"lost.obj\"\n");
    write("lost2.toml", "scene = \"lostmesh.toml\"\n");
    expect("render lost2.toml", 66, "lostmesh.toml:3:");
    write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    expect("render bad.obj", 65, "bad.obj:4: 1 of 1 faces refer to vertices that do not exist");
    write("empty.obj", "");
    expect("render empty.obj", 65, "the file is empty");
    write("binary.obj", std::string("\x00\x01\xff\xfe garbage \x7f", 18));
    expect("render binary.obj", 65, "the file is binary");
    write("instance.toml", "[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n[[instance]]\nmesh = \"n\"\n");
    write("i.toml", "scene = \"instance.toml\"\n");
    expect("render i.toml", 64, "instance.toml:5:8: there is no mesh named 'n'");
    write("loop.toml", "include = [\"loop.toml\"]\n");
    expect("render loop.toml", 64, "includes itself");
}

TEST_F(Errors, whatCannotBeWrittenOrReadIsSaidBeforeDrawing) {
    expect("render config.toml --stats config.toml/stats.json", 73, "making the folder failed");
    expect("render config.toml --shader-dir .", 66, "holds no shaders of limn");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_F(Errors, whatWouldTakeTooMuchIsRefusedBeforeItIsTaken) {
    std::string grid;  // a cage of 1024 faces
    for (int y = 0; y <= 32; ++y)
        for (int x = 0; x <= 32; ++x) grid += fmt::format("v {} {} 0\n", x, y);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const int first = y * 33 + x + 1;
            grid += fmt::format("f {} {} {} {}\n", first, first + 1, first + 34, first + 33);
        }
    write("grid.obj", grid);
    for (const char* subdivision :
        {"level = 9", "level = 10", "edge_length = '1e-308'", "level = 10, scheme = 'bilinear'"}) {
        write(
            "fine.toml", fmt::format("[[mesh]]\nname = 'm'\nfile = 'grid.obj'\nsubdivision = {{ {} }}\n", subdivision));
        expect("render config.toml --memory-limit 4G --set scene=fine.toml", 33, "subdivision makes ");
    }
    for (const char* light : {"kind = 'point'", "kind = 'spot'", "shadow.resolution = 8192"}) {
        std::string lights = "[[mesh]]\nname = 'm'\nfile = 'grid.obj'\n";
        for (int i = 0; i < 200; ++i)
            lights += fmt::format("[[light]]\nname = 'l{}'\nshadow.softness = 1\n{}\n", i, light);
        write("lights.toml", lights);
        expect("render config.toml --set scene=lights.toml --set shading.technique=toon", 33,
            "the shadows of 200 lights take ");
    }
    const Image grey{4096, 4096, 1, std::vector<float>(std::size_t{4096} * 4096)};
    const auto png =
        encodeImage(*imageFormat("grey.png"), std::vector{Layer{"grey", {"Y"}, false, false, grey}}, {}, {});
    replaceFile(folder.path() / "grey.png", png);
    write("images.toml",
        "[[mesh]]\nname = 'm'\nfile = 'uv.obj'\n[[instance]]\nmesh = 'm'\nmaterial = 'g'\n"
        "[[material]]\nname = 'g'\ntexture = 'grey.png'\n");
    write("uv.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    expect("render config.toml --memory-limit 400M --set scene=images.toml", 33, "the scene shows 1 image as textures");
    EXPECT_EQ(run("render config.toml --set scene=images.toml").exitCode, 0);
    EXPECT_EQ(run("render config.toml --memory-limit lots").exitCode, 64);
    expect("render config.toml --set frames=1-999999999", 64, "at most 1000000 frames");
    expect("render config.toml --frames 1-999999999", 64, "at most 1000000 frames");
    expect("render /dev/zero", 66, "longer than 64 MiB");
    // Fits: several tiles of one picture.
    EXPECT_EQ(
        run("render config.toml --memory-limit 2G --set image.size=[2000,1500] --set image.tile=256").exitCode, 0);
}

TEST_F(Errors, anotherTechniqueTakesWhatFits) {
    write("toon.toml", kConfig + "[shading]\ntechnique = 'toon'\nbands = 3\nfloor = 0.5\n[[edges]]\ntechnique = "
                                 "'depth_normal'\nwidth = '3px'\ncreases = 0\n");
    const RunResult paper = run("render toon.toml --set shading.technique=paper");
    EXPECT_EQ(paper.exitCode, 0) << paper.err;
    EXPECT_NE(paper.err.find("--set shading.technique=paper: without bands and floor"), std::string::npos) << paper.err;
    const RunResult lines = run("render toon.toml --set edges.0.technique=laplacian");
    EXPECT_EQ(lines.exitCode, 0) << lines.err;
    EXPECT_NE(lines.err.find("without creases,"), std::string::npos) << lines.err;
    // The same technique, and what is wrong in any.
    EXPECT_EQ(run("render toon.toml --set shading.technique=toon").err.find("without"), std::string::npos);
    expect("render toon.toml --set shading.bands=paper", 64, "'bands'");
}

TEST_F(Errors, framesAndKeyframes) {
    write("scene.toml",
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[instance]]\nmesh = 'm'\ntranslate = [[1, [0, 0, 0]], "
        "[24, [2, 0, 0]]]\n");
    expect("render config.toml", 64, "for keyframes write { keys = [[1, VALUE], [24, VALUE]] }");
    write("scene.toml", "[animation]\nframes = '1-3'\n[[mesh]]\nname = 'm'\nfile = 'm.obj'\n");
    const RunResult beyond = run("render config.toml --frames 2-5 --output out/p_#.png");
    EXPECT_EQ(beyond.exitCode, 0);
    EXPECT_NE(beyond.err.find("2 of 4 frames lie beyond 1-3"), std::string::npos) << beyond.err;
    EXPECT_EQ(run("render config.toml --output out/p_#.png").err.find("beyond"), std::string::npos);
}

TEST_F(Errors, techniquesKnowsTables) {
    for (const char* topic : {"camera", "frames", "sheet", "scene", "config", "image", "shadow", "hbao", "edges"}) {
        const RunResult text = run(std::string("techniques ") + topic);
        EXPECT_EQ(text.exitCode, 0) << topic;
        EXPECT_GT(text.out.size(), 200u) << topic;
    }
    EXPECT_NE(run("techniques camera").out.find("focal_length"), std::string::npos);
    EXPECT_EQ(run("techniques camera").out.find("hbao"), std::string::npos);
    const std::string everything = run("techniques").out;
    for (const char* key : {"focal_length", "hatch_angle", "line_samples", "resolution", "keyframes", "texture_filter"})
        EXPECT_NE(everything.find(key), std::string::npos) << key;
    expect("techniques camra", 64, "did you mean 'camera'?");
}

TEST_F(Errors, theLauncherSaysWhereItMayNotBuild) {
    if (geteuid() != 0) GTEST_SKIP() << "becoming somebody else needs root";
    std::filesystem::copy(std::filesystem::path(LIMN_SOURCE_DIR) / "limn", folder.path() / "limn");
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    const auto launch = [&] {
        return WEXITSTATUS(std::system(fmt::format(
            "cd '{}' && LIMN_PRESET=release setpriv --reuid=65534 --clear-groups ./limn --version >said 2>&1",
            folder.path().string())
                                           .c_str()));
    };
    EXPECT_EQ(launch(), 77);
    EXPECT_NE(readFile(folder.path() / "said").find("cannot be written to"), std::string::npos);
    // What is built there is run.
    std::filesystem::create_directories(folder.path() / "build/release");
    write("build/release/limn", "#!/bin/sh\necho built $1\n");
    std::filesystem::permissions(folder.path() / "build/release/limn", std::filesystem::perms(0755));
    EXPECT_EQ(launch(), 0);
    EXPECT_EQ(readFile(folder.path() / "said"), "built --version\n");
}

TEST_F(Errors, placesThatCannotBeWritten) {
    write("file", "in the way");
    const RunResult r = run("render config.toml --output file/picture.png");
    EXPECT_EQ(r.exitCode, 73) << r.err;
    EXPECT_EQ(run("render config.toml --output /proc/picture.png").exitCode, 73);
    // Root may write anywhere: try as somebody else, with the picture's folder closed.
    std::filesystem::create_directory(folder.path() / "closed");
    std::filesystem::permissions(folder.path() / "closed", std::filesystem::perms(0555));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    if (geteuid() == 0) {
        const int status =
            std::system(fmt::format("cd '{}' && setpriv --reuid=65534 --clear-groups '{}' render config.toml --output "
                                    "closed/picture.png 2>'{}/said'",
                folder.path().string(), LIMN_PROGRAM, std::filesystem::temp_directory_path().string())
                            .c_str());
        EXPECT_EQ(WEXITSTATUS(status), 77);
    } else {
        EXPECT_EQ(run("render config.toml --output closed/picture.png").exitCode, 77);
    }
}

std::string bytesOf(const std::filesystem::path& path) { return std::filesystem::exists(path) ? readFile(path) : ""; }

TEST_F(Errors, aFullDiskKeepsTheOldPicture) {
    const auto disk = folder.path() / "disk";
    std::filesystem::create_directory(disk);
    if (geteuid() != 0 || ::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=32k") != 0)
        GTEST_SKIP() << "mounting a small file system needs root; the limits below test the same path";
    // Noise does not compress.
    write("m.obj", mixedObj());
    write(
        "large.toml", kConfig + "aovs = [\"beauty\", \"depth\"]\n[ao]\ntechnique = \"toon_ssao\"\nradius = \"30%\"\n");
    for (const char* format : {"png", "jpg", "tif", "exr"}) {
        const auto picture = disk / (std::string("picture.") + format);
        std::ofstream(picture) << "the old picture";
        std::ofstream(disk / "filler") << std::string(20000, 'x');
        const RunResult r = run(
            fmt::format("render large.toml --set image.size=[400,300] --set output.bits={} --output disk/picture.{}",
                std::string(format) == "png" || std::string(format) == "tif" ? 16 : 8, format));
        EXPECT_EQ(r.exitCode, 74) << format << r.err;
        EXPECT_TRUE(bytesOf(picture) == "the old picture") << format;
        EXPECT_EQ(temporaries(), 0) << format;
        std::filesystem::remove(picture);
    }
    ::umount(disk.c_str());
}

// Every way that writing can be cut short: a limit on the file's size at a thousand offsets, for each format. No GL
// here, so that a child process can take the limit upon itself.
TEST_F(Errors, aFileCutOffAnywhereIsNoticed) {
    std::signal(SIGXFSZ, SIG_IGN);
    Layer layer{"beauty", {"R", "G", "B"}, true, false, {48, 32, 3, std::vector<float>(48 * 32 * 3)}};
    for (std::size_t i = 0; i < layer.image.pixels.size(); ++i)
        layer.image.pixels[i] = static_cast<float>((i * 2654435761u >> 8) % 1000) / 1000;
    for (const char* format : {"png", "jpg", "tif", "exr"}) {
        const auto path = folder.path() / (std::string("p.") + format);
        const auto encoded = encodeImage(*imageFormat(path), {&layer, 1}, {{"Software", "test"}}, {});
        ASSERT_GT(encoded.size(), 500u);
        int silent = 0, wrongCode = 0, damaged = 0;
        for (int i = 0; i < 1000; ++i) {
            const auto limit = static_cast<rlim_t>(encoded.size() * static_cast<std::size_t>(i) / 1000);
            const std::string old = "what stood there before";
            replaceFile(path, old);
            const pid_t child = fork();
            if (child == 0) {
                const rlimit bound{limit, limit};
                setrlimit(RLIMIT_FSIZE, &bound);
                try {
                    replaceFile(path, encoded);
                    _exit(0);
                } catch (const Error& error) { _exit(static_cast<int>(error.code)); }
            }
            int status = 0;
            waitpid(child, &status, 0);
            silent += WEXITSTATUS(status) == 0;
            wrongCode += WEXITSTATUS(status) != 74;
            damaged += bytesOf(path) != old;
        }
        EXPECT_EQ(silent, 0) << format;
        EXPECT_EQ(wrongCode, 0) << format;
        EXPECT_EQ(damaged, 0) << format;
        EXPECT_EQ(temporaries(), 0) << format;
    }
}

TEST_F(Errors, theSameInputGivesTheSameBytes) {
    write("all.toml",
        kConfig
            + "aovs = [\"beauty\", \"depth\", \"normal\", \"object_id\", \"ambient_occlusion\"]\n"
              "[shading]\ntechnique = \"toon\"\n[ao]\ntechnique = \"toon_ssao\"\n"
              "[[edges]]\ntechnique = \"depth_normal\"\n");
    write("m.obj", mixedObj());
    const auto draw = [&](const std::string& arguments, const std::string& environment, const std::string& file) {
        const RunResult r = run(arguments, environment);
        EXPECT_EQ(r.exitCode, 0) << r.err;
        return bytesOf(folder.path() / file);
    };
    for (const char* format : {"exr", "png", "tif", "jpg"}) {
        const std::string file = std::string("a.") + format;
        const std::string first =
            draw("render all.toml --set image.samples=5 --output " + file, "LP_NUM_THREADS=1", file);
        EXPECT_GT(first.size(), 500u);
        for (const char* environment : {"LP_NUM_THREADS=2", "LP_NUM_THREADS=4", "LP_NUM_THREADS=0", "",
                 "TZ=Asia/Tokyo LC_ALL=C", "HOME=/nonexistent"})
            EXPECT_EQ(draw("render all.toml --set image.samples=5 --output " + file, environment, file), first)
                << format << " " << environment;
        EXPECT_EQ(draw("render all.toml --threads 1 --set image.samples=5 --output " + file, "", file), first)
            << format << " --threads 1";
    }
    // Alone, in a batch after another, and as one of several frames.
    const std::string alone = draw("render all.toml --output alone.exr", "", "alone.exr");
    draw("render config.toml all.toml --output batch_{config}.exr", "", "batch_all.exr");
    EXPECT_EQ(bytesOf(folder.path() / "batch_all.exr"), alone);
    draw("render all.toml --frames 0-2 --output frame_####.exr", "", "frame_0001.exr");
    EXPECT_EQ(bytesOf(folder.path() / "frame_0001.exr"), alone);
}

TEST_F(Errors, aProjectMovedElsewhereGivesTheSameBytes) {
    ASSERT_EQ(run("render config.toml --output weave.png").exitCode, 0);
    std::vector<std::string> pictures;
    for (const char* place : {"here", "over/there"}) {
        const std::string at = std::string(place) + "/";
        std::filesystem::create_directories(folder.path() / at);
        std::filesystem::copy_file(folder.path() / "weave.png", folder.path() / (at + "weave.png"));
        write(at + "m.obj", "vt 0 0\nvt 1 0\nvt 1 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n");
        write(at + "scene.toml",
            "[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n[[material]]\nname = \"t\"\ntexture = \"weave.png\"\n"
            "[[instance]]\nmesh = \"m\"\nmaterial = \"t\"\n");
        write(at + "config.toml", kConfig);
        const RunResult r = run("render " + at + "config.toml");
        ASSERT_EQ(r.exitCode, 0) << r.err;
        pictures.push_back(bytesOf(folder.path() / (at + "out/picture.png")));
    }
    EXPECT_GT(pictures[0].size(), 200u);
    EXPECT_EQ(pictures[0], pictures[1]) << "what is told of a picture is told of its content";
}

TEST_F(Errors, initWritesSomethingThatDraws) {
    EXPECT_EQ(run("init m.obj --output start").exitCode, 0);
    const RunResult check = run("check start/m.toml");
    EXPECT_EQ(check.exitCode, 0) << check.err;
    EXPECT_EQ(run("render start/m.toml").exitCode, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "start/m.png"));
    EXPECT_EQ(run("init m.obj --output start").exitCode, 73) << "what stands there is not overwritten";
    EXPECT_EQ(run("render m.obj").exitCode, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "m.png"));
}

TEST_F(Errors, initFindsAModelFarFromTheOrigin) {
    const glm::dvec3 far(458213, -5432110, 77);
    write("it's far.obj", boxObj(far - 1.0, far + 1.0));
    const RunResult made = run("init \"it's far.obj\" --output start");
    EXPECT_NE(made.err.find("render 'start/it'\\''s far.toml'"), std::string::npos)
        << "as a shell reads it: " << made.err;
    ASSERT_EQ(run("render \"start/it's far.toml\" --set image.size=[64,64]").exitCode, 0);
    const Image picture = readImage(folder.path() / "start/it's far.png");
    int drawn = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) drawn += *picture.at(x, y) != *picture.at(0, 0);
    EXPECT_GT(drawn, 64 * 64 / 10);
}

TEST_F(Errors, scenesAndConfigsAreToldApart) {
    for (const char* command : {"check", "render", "plan"})
        expect(std::string(command) + " scene.toml", 64, "is a scene, not a config");
    write("loop.toml", "scene = \"config.toml\"\n");
    expect("render loop.toml", 65, "is a config, not a scene");
}

TEST_F(Errors, initKeepsSceneAndConfigApart) {
    write("scene.obj", boxObj({-1, -1, -1}, {1, 1, 1}));
    EXPECT_EQ(run("init scene.obj --output start").exitCode, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "start/scene.toml"));
    EXPECT_EQ(run("check start/picture.toml").exitCode, 0);
    expect("init scene.toml --output other", 64, "is no mesh file");
}

TEST_F(Errors, planDoctorAndTechniquesAnswer) {
    EXPECT_NE(run("plan config.toml").out.find("not asked for: ao, edges"), std::string::npos);
    EXPECT_NE(run("plan config.toml --format json").out.find("\"passes\": ["), std::string::npos);
    EXPECT_NE(run("plan config.toml --format dot").out.find("digraph"), std::string::npos);
    EXPECT_NE(run("plan config.toml --measure").out.find(" ms"), std::string::npos);
    EXPECT_NE(run("doctor").out.find("works"), std::string::npos);
    EXPECT_NE(run("techniques toon").out.find("bands"), std::string::npos);
    EXPECT_NE(run("techniques --format json").out.find("\"accuracy\": true"), std::string::npos);
    EXPECT_NE(run("techniques --format markdown").out.find("| `radius` |"), std::string::npos);
    EXPECT_EQ(run("--version").exitCode, 0);
    EXPECT_EQ(run("").exitCode, 64);
    EXPECT_EQ(run("render").exitCode, 64);
    EXPECT_EQ(run("render --help").exitCode, 0);
}

}  // namespace
}  // namespace limn::test
