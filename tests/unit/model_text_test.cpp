// What a file is that came under the name of a model.

#include "formats/model_text.h"
#include "base/error.h"
#include "formats/mtl.h"
#include "formats/obj.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

using namespace std::string_literals;

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Größe 木 😀\nf 1 2 3\n";

std::string problemOf(const std::string& bytes) {
    try {
        parseObj(bytes, "m.obj");
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::badData);
        return error.message;
    }
    return "";
}

std::string utf16(std::string_view utf8, bool isLittle) {
    std::string bytes = isLittle ? "\xFF\xFE"s : "\xFE\xFF"s;
    const auto unit = [&](std::uint32_t value) {
        const char high = static_cast<char>(value >> 8), low = static_cast<char>(value & 0xFF);
        bytes += isLittle ? low : high;
        bytes += isLittle ? high : low;
    };
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i]);
        const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        std::uint32_t code = length == 1 ? lead : lead & (0x7Fu >> length);
        for (std::size_t k = 1; k < length; ++k) code = code << 6 | (static_cast<unsigned char>(utf8[i + k]) & 0x3Fu);
        i += length;
        if (code < 0x10000) {
            unit(code);
        } else {
            unit(0xD800 + ((code - 0x10000) >> 10));
            unit(0xDC00 + ((code - 0x10000) & 0x3FF));
        }
    }
    return bytes;
}

TEST(ModelText, readsOtherEncodingsAndLineEnds) {
    std::string mac(kTriangle), windows;
    for (char& c : mac)
        if (c == '\n') c = '\r';
    for (const char c : kTriangle) windows += c == '\n' ? "\r\n" : std::string(1, c);
    for (const std::string& bytes : {std::string(kTriangle), "\xEF\xBB\xBF" + std::string(kTriangle),
             utf16(kTriangle, true), utf16(kTriangle, false), mac, utf16(mac, true), windows}) {
        const ObjFile file = parseObj(bytes, "m.obj");
        EXPECT_EQ(file.mesh.faceCount(), 1u);
        EXPECT_EQ(file.mesh.materialNames, std::vector<std::string>{"Größe 木 😀"});
        EXPECT_TRUE(file.warnings.empty());
    }
    EXPECT_EQ(parseMtl(utf16("newmtl ä\nKd 1 0 0\n", true), "/").materials.at(0).name, "ä");
    // Halves of pairs, and an odd number of bytes, are no reason to end.
    EXPECT_EQ(ModelText("\xFF\xFE\x00\xD8v\0 \0x"s, "m").text(), "\xEF\xBF\xBDv ");
    EXPECT_EQ(ModelText("\xFF\xFE\x3D\xD8"s, "m").text(), "\xEF\xBF\xBD");
}

TEST(ModelText, saysWhatTheFileIsInstead) {
    const std::pair<std::string, const char*> files[] = {
        {"", "empty"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 12\n", "run git lfs pull"},
        {"<!DOCTYPE html><html></html>", "a web page"},
        {"\n  <HTML lang='en'>", "a web page"},
        {"<?xml version='1.0'?><COLLADA>", "COLLADA"},
        {"PK\x03\x04rest", "ZIP"},
        {"\x1F\x8B\x08rest", "gzip"},
        {"BZh91AY", "bzip2"},
        {"\xFD\x37zXZ\0"s, "xz"},
        {"\x28\xB5\x2F\xFDrest", "zstd"},
        {"BLENDER-v304", "a Blender file"},
        {"glTF\x02\0\0\0"s, "glTF"},
        {"Kaydara FBX Binary  \0"s, "FBX"},
        {"ply\nformat ascii 1.0\n", "PLY"},
        {"solid cube\nfacet normal 0 0 1\n", "STL"},
        {"\x89PNG\r\n", "a PNG picture"},
        {"v 0 0 0\0\0\0"s, "binary"},
        {"v 0,5 0,0 0,0\nv 1,0 0,0 0,0\nv 0,0 1,0 0,0\nf 1 2 3\n", "decimal commas"},
    };
    for (const auto& [bytes, what] : files) {
        const std::string problem = problemOf(bytes);
        EXPECT_NE(problem.find(what), std::string::npos) << what << ": " << problem;
        EXPECT_EQ(problem.find("m.obj: "), 0u) << problem;
    }
    EXPECT_EQ(problemOf("# nothing yet\n"), "") << "an animation may begin with nothing";
    EXPECT_EQ(problemOf("solidary comment\nv 0 0 0\nf 1 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "");
}

}  // namespace
}  // namespace limn
