// How the sources are written: lines of at most 120 columns, functions of at most 60 lines, few places that catch. What
// is allowed to differ stands here, with its reason.

#include "base/file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace limn {
namespace {

const std::filesystem::path kTop = LIMN_SOURCE_DIR;

// Longer functions: file and name.
const std::map<std::string, std::string> kLongFunctions{
    {"src/mesh/far.cpp refineUniformly", "one walk over the levels of Far's refiner, each step needs the one before"},
    {"src/mesh/far.cpp makeRefiner", "one description for OpenSubdiv, which keeps pointers into what it is made of"},
    {"src/mesh/tri_mesh.cpp triangulateMesh", "one pass over the faces that fills all attributes side by side"},
    {"src/mesh/tessellate.cpp evaluate", "one face's points in the order in which Bfr gives them"},
    {"src/mesh/tessellate.cpp layOut", "counts and places in one walk over the faces"},
    {"src/formats/obj.cpp readLine", "one case for each keyword of OBJ"},
    {"src/formats/obj.cpp addTag", "one case for each tag of OpenSubdiv"},
    {"src/rays/ambient_occlusion.cpp traceAmbientOcclusion",
        "the loop over pixels and rays, with what it keeps for each"},
    {"tests/unit/subdivide_test.cpp lieOnTheLimitSurface", "one shape after the other"},
    {"tests/blender/animation_test.cpp ofBlenderIsWrittenFrameByFrame", "one export, looked at from all sides"},
};

// Places that catch, besides main.cpp: file, how many, and why an error may not simply fly on.
const std::map<std::string, std::pair<int, std::string>> kCatches{
    {"src/base/error.h", {2, "collect(): several errors at once"}},
    {"src/base/in_order.h", {1, "hands over from threads"}},
    {"src/base/file.cpp", {1, "removes the temporary file, and throws on"}},
    {"src/job/behind.cpp", {1, "hands over from a thread"}},
    {"src/image/exr.cpp", {2, "turns the library's exceptions into errors; a damaged file is none"}},
    {"src/image/module.cpp", {1, "a module that cannot be loaded ahead is loaded when it is needed"}},
    {"src/settings/document.cpp", {3, "adds a place; turns the library's exceptions into errors; not TOML: text"}},
    {"src/formats/mtl.cpp", {1, "a missing library is a warning"}},
    {"src/render/pipeline.cpp", {1, "adds the config's name"}},
    {"src/study/knobs.cpp", {2, "a value that a config refuses is none of a knob's"}},
    {"src/study/sweep.cpp", {1, "a setting that cannot be drawn is named, and the study goes on"}},
    {"src/study/results.cpp", {1, "figures that cannot be read are begun anew"}},
    {"src/cli/doctor.cpp", {1, "what does not work is what is asked for"}},
};

std::vector<std::string> sources() {
    std::vector<std::string> files;
    for (const char* folder : {"src", "tests", "shaders"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(kTop / folder)) {
            static const std::set<std::string> kinds{".cpp", ".h", ".glsl", ".comp", ".frag", ".vert", ".py", ".sh"};
            if (kinds.contains(entry.path().extension()))
                files.push_back(std::filesystem::relative(entry.path(), kTop).string());
        }
    return files;
}

std::vector<std::string> linesOf(const std::string& file) {
    std::vector<std::string> lines{""};
    for (const char c : readFile(kTop / file)) c == '\n' ? void(lines.emplace_back()) : void(lines.back() += c);
    return lines;
}

/// Columns of UTF-8.
int widthOf(const std::string& line) {
    int width = 0;
    for (const char c : line) width += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return width;
}

struct Function {
    std::string name;
    int line = 0, length = 0;
};

std::size_t indentOf(const std::string& line) { return std::min(line.find_first_not_of(' '), line.size()); }

/// Functions at the level of namespaces and classes, as clang-format lays them out: from the line that names them to
/// the brace below it.
std::vector<Function> functionsOf(const std::vector<std::string>& lines) {
    static const std::regex opens(R"(.*\)( const| noexcept| override)*( ->.*)? \{|.*[)}\w] \{)");
    static const std::regex other(R"(\s*(namespace|class|struct|enum|union|if|for|while|switch|else|do|try|\}|//).*)");
    static const std::regex named(R"(([\w:~]+)\()");
    std::vector<Function> functions;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::size_t begin = i;
        const bool isOpen = std::regex_match(lines[i], opens);
        while (isOpen && begin > 0 && indentOf(lines[begin]) > 4) --begin;
        if (!isOpen || std::regex_match(lines[begin], other)) continue;
        while (begin > 0 && indentOf(lines[begin]) > indentOf(lines[begin - 1]) && !lines[begin - 1].empty()
            && lines[begin - 1].back() != '{' && lines[begin - 1].back() != ':' && lines[begin - 1].back() != ';')
            --begin;
        std::smatch match;
        std::string head = lines[begin];
        if (head.starts_with("TEST")) head = std::regex_replace(head, std::regex(R"(.*, (\w+)\).*)"), "$1(");
        if (!std::regex_search(head, match, named)) continue;
        const std::string closing = std::string(indentOf(lines[begin]), ' ') + "}";
        std::size_t end = i + 1;
        while (end < lines.size() && !lines[end].starts_with(closing)) ++end;
        functions.push_back({match[1], static_cast<int>(begin) + 1, static_cast<int>(end - begin) + 1});
        i = end;
    }
    return functions;
}

TEST(Style, linesFitIn120Columns) {
    int checked = 0;
    for (const auto& file : sources()) {
        int number = 0;
        for (const auto& line : linesOf(file)) {
            ++number;
            EXPECT_LE(widthOf(line), 120) << file << ":" << number;
            ++checked;
        }
    }
    EXPECT_GT(checked, 20000);
}

TEST(Style, functionsFitOnAScreen) {
    std::set<std::string> met;
    int count = 0;
    for (const auto& file : sources()) {
        if (!file.ends_with(".cpp") && !file.ends_with(".h")) continue;
        for (const auto& function : functionsOf(linesOf(file))) {
            ++count;
            const std::string name = function.name.substr(function.name.rfind(':') + 1);
            if (function.length <= 60) continue;
            met.insert(file + " " + name);
            EXPECT_TRUE(kLongFunctions.contains(file + " " + name))
                << file << ":" << function.line << ": " << name << " has " << function.length << " lines";
        }
    }
    EXPECT_GT(count, 800);
    for (const auto& [name, reason] : kLongFunctions)
        EXPECT_TRUE(met.contains(name)) << name << " is not long any more";
}

TEST(Style, errorsAreCaughtInMain) {
    std::map<std::string, int> found;
    for (const auto& file : sources())
        if (file.starts_with("src/") && file != "src/main.cpp")
            for (const auto& line : linesOf(file)) {
                const bool isComment = indentOf(line) < line.size() && line.compare(indentOf(line), 2, "//") == 0;
                for (std::size_t at = line.find("catch ("); !isComment && at != std::string::npos;
                     at = line.find("catch (", at + 1))
                    ++found[file];
            }
    for (const auto& [file, count] : found) {
        const auto known = kCatches.find(file);
        EXPECT_EQ(count, known == kCatches.end() ? 0 : known->second.first) << file;
    }
    for (const auto& [file, known] : kCatches) EXPECT_TRUE(found.contains(file)) << file << " catches nothing any more";
}

}  // namespace
}  // namespace limn
