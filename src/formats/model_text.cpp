#include "formats/model_text.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace limn {
namespace {

/// Files that are met under the name of a model, by how they begin.
struct Kind {
    std::string_view begin, what, remedy;
};
constexpr Kind kKinds[] = {
    {"version https://git-lfs", "a Git LFS pointer: it stands for a file that has not been downloaded",
        "run git lfs pull"},
    {"<!doctype", "a web page", "download the model itself"},
    {"<html", "a web page", "download the model itself"},
    {"<?xml", "XML, perhaps COLLADA or X3D", "export the model as OBJ"},
    {"PK\x03\x04", "a ZIP archive", "unpack it first"},
    {"\x1F\x8B", "compressed by gzip", "unpack it first"},
    {"BZh", "compressed by bzip2", "unpack it first"},
    {"\xFD\x37zXZ", "compressed by xz", "unpack it first"},
    {"\x28\xB5\x2F\xFD", "compressed by zstd", "unpack it first"},
    {"7z\xBC\xAF\x27\x1C", "a 7z archive", "unpack it first"},
    {"Rar!", "a RAR archive", "unpack it first"},
    {"%PDF", "a PDF", "export the model as OBJ"},
    {"BLENDER", "a Blender file", "export it with limn's exporter, or as OBJ"},
    {"glTF", "binary glTF", "export the model as OBJ"},
    {"Kaydara FBX", "FBX", "export the model as OBJ"},
    {"ply\n", "PLY", "export the model as OBJ"},
    {"ply\r", "PLY", "export the model as OBJ"},
    {"solid ", "STL", "export the model as OBJ"},
    {"\x89PNG", "a PNG picture", "check the path"},
    {"\xFF\xD8\xFF", "a JPEG picture", "check the path"},
};

[[noreturn]] void refuse(const std::string& file, std::string_view what, std::string_view remedy) {
    throw Error(ExitCode::badData, {file}, fmt::format("the file is {}", what), std::string(remedy));
}

void appendUtf8(std::string& text, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) return put(code);
    if (code < 0x800) {
        put(0xC0u | code >> 6);
    } else {
        if (code < 0x10000) {
            put(0xE0u | code >> 12);
        } else {
            put(0xF0u | code >> 18);
            put(0x80u | (code >> 12 & 0x3Fu));
        }
        put(0x80u | (code >> 6 & 0x3Fu));
    }
    put(0x80u | (code & 0x3Fu));
}

/// `low`: where in each pair of bytes the lower one stands.
std::string fromUtf16(std::string_view bytes, std::size_t low) {
    std::string text;
    text.reserve(bytes.size() / 2);
    const auto unit = [&](std::size_t at) {
        return std::uint32_t{static_cast<unsigned char>(bytes[at + low])}
        | std::uint32_t{static_cast<unsigned char>(bytes[at + 1 - low])} << 8;
    };
    for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
        std::uint32_t code = unit(at);
        const bool isHigh = code >= 0xD800 && code < 0xDC00, hasNext = at + 3 < bytes.size();
        if (const std::uint32_t next = isHigh && hasNext ? unit(at + 2) : 0; next >= 0xDC00 && next < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (next - 0xDC00);
            at += 2;
        } else if (code >= 0xD800 && code < 0xE000) {
            code = 0xFFFD;  // half of a pair
        }
        appendUtf8(text, code);
    }
    return text;
}

}  // namespace

ModelText::ModelText(std::string_view bytes, const std::string& file) : bytes_(bytes) {
    if (bytes_.empty()) refuse(file, "empty", "export the model again");
    if (bytes_.starts_with("\xFF\xFE") || bytes_.starts_with("\xFE\xFF")) {
        converted_ = fromUtf16(bytes_.substr(2), bytes_.starts_with("\xFF\xFE") ? 0 : 1);
        isConverted_ = true;
    } else if (bytes_.starts_with("\xEF\xBB\xBF")) {
        bytes_.remove_prefix(3);
    }
    const std::string_view head = text().substr(0, 4096);
    const std::string start = lowerCase(head.substr(std::min(head.find_first_not_of(" \t\r\n"), head.size()), 32));
    for (const auto& kind : kKinds)
        if (head.starts_with(kind.begin) || (kind.begin[0] == '<' && start.starts_with(kind.begin)))
            refuse(file, kind.what, kind.remedy);
    if (head.find('\0') != std::string_view::npos) refuse(file, "binary, and no text", "export the model as OBJ");
    if (text().find('\n') == std::string_view::npos && text().find('\r') != std::string_view::npos) {
        if (!isConverted_) converted_ = bytes_;
        isConverted_ = true;
        std::replace(converted_.begin(), converted_.end(), '\r', '\n');
    }
}

}  // namespace limn
