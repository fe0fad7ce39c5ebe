#include "formats/obj.h"

#include "base/file.h"
#include "formats/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace limn {
namespace {

Color readColor(Cursor& cursor) {
    double rgb[3] = {0, 0, 0};
    for (int i = 0; i < 3; ++i) {
        if (i > 0 && cursor.atEnd()) {
            rgb[i] = rgb[0];
            continue;
        }  // one number means grey
        if (!cursor.number(rgb[i]) || !std::isfinite(rgb[i])) rgb[i] = 0;
    }
    const auto channel = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 65504.0)); };
    return {channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
}

/// The file name of a map statement, after its options: "-s 1 1 1 -bm 0.5 wood grain.png".
std::string_view mapFile(Cursor cursor) {
    while (!cursor.atEnd() && *cursor.at == '-') {
        const Cursor before = cursor;
        const auto option = cursor.word();
        int arguments = option == "-o" || option == "-s" || option == "-t" ? 3 : option == "-mm" ? 2 : 1;
        if (option.size() < 2 || !std::isalpha(static_cast<unsigned char>(option[1]))) {
            cursor = before;
            break;
        }
        const bool numeric = arguments == 3;
        while (arguments-- > 0) {
            const Cursor argument = cursor;
            double value;
            if (numeric && !cursor.number(value)) {
                cursor = argument;
                break;
            }  // -s may have one to three numbers
            if (!numeric) cursor.word();
        }
    }
    return cursor.rest();
}

}  // namespace

std::vector<Material> parseMtl(
    std::string_view text, const std::filesystem::path& folder, std::vector<MeshWarning>& warnings) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<Material> materials;
    WarningList found;
    double exponent = 0;
    Color specular;
    const auto finish = [&] {
        if (materials.empty()) return;
        materials.back().specular = std::min(1.0f, std::max({specular.r, specular.g, specular.b}));
        materials.back().shininess =
            materials.back().specular > 0 ? static_cast<float>(std::clamp(exponent, 0.0, 10000.0)) : 0.0f;
    };
    forEachLine(text, [&](std::string_view line, int number) {
        Cursor cursor{line.data(), line.data() + line.size()};
        const auto keyword = cursor.word();
        if (keyword == "newmtl") {
            finish();
            materials.push_back({.name = std::string(cursor.rest())});
            exponent = 0;
            specular = {};
        } else if (materials.empty()) {
            if (!keyword.empty() && keyword[0] != '#')
                found.add("material property before the first newmtl; skipped", number);
        } else if (keyword == "Kd") {
            materials.back().color = readColor(cursor);
        } else if (keyword == "Ks") {
            specular = readColor(cursor);
        } else if (keyword == "Ns") {
            if (!cursor.number(exponent) || !std::isfinite(exponent)) exponent = 0;
        } else if (keyword == "map_Kd" || keyword == "map_d") {
            std::string file(mapFile(cursor));
            std::replace(file.begin(), file.end(), '\\', '/');
            if (file.empty()) return;
            const auto path = folder / file;
            if (fileExists(path))
                (keyword == "map_d" ? materials.back().cutout : materials.back().texture) = path.string();
            else
                found.add(fmt::format("texture '{}' is missing; drawn without", path.string()), number);
        }
    });
    finish();
    for (auto& warning : found.list()) warnings.push_back(std::move(warning));
    return materials;
}

std::vector<Material> readMaterials(const std::filesystem::path& objPath, const PolyMesh& mesh,
    std::vector<MeshWarning>& warnings, std::vector<std::filesystem::path>* files) {
    std::vector<Material> materials;
    const auto readLibrary = [&](const std::filesystem::path& path) {
        try {
            for (auto& material : parseMtl(readFile(path), path.parent_path(), warnings))
                materials.push_back(std::move(material));
            if (files) files->push_back(path);
        } catch (const Error& error) {
            warnings.push_back(
                {fmt::format("material library '{}' {}; drawn without", path.string(), error.problem), 1, 0});
        }
    };
    for (const auto& line : mesh.materialLibraries) {
        const auto whole = objPath.parent_path() / line;
        if (fileExists(whole)) {  // the name itself may hold spaces
            readLibrary(whole);
            continue;
        }
        // Several names; a backslash keeps a space within one.
        std::string name;
        for (std::size_t i = 0; i <= line.size(); ++i) {
            if (i < line.size() && !isBlank(line[i])) {
                if (line[i] == '\\' && i + 1 < line.size() && isBlank(line[i + 1])) ++i;
                name += line[i];
            } else if (!name.empty()) {
                readLibrary(objPath.parent_path() / name);
                name.clear();
            }
        }
    }
    return materials;
}

}  // namespace limn
