// MTL: materials beside an OBJ, as many programs write them.

#include "formats/mtl.h"

#include "base/file.h"
#include "base/text.h"
#include "formats/find_file.h"
#include "formats/model_text.h"
#include "formats/obj_text.h"
#include "mesh/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace limn {
namespace {

/// The linear Rec.709 colour of CIE XYZ with the white of D65 (IEC 61966-2-1).
std::array<double, 3> rgbFromXyz(const std::array<double, 3>& c) {
    return {3.2406 * c[0] - 1.5372 * c[1] - 0.4986 * c[2], -0.9689 * c[0] + 1.8758 * c[1] + 0.0415 * c[2],
        0.0557 * c[0] - 0.2040 * c[1] + 1.0570 * c[2]};
}

/// What `map_Kd -s 2 2 1 -clamp on wood grain.png` says.
struct MapStatement {
    std::string file;
    glm::dvec2 scale{1}, offset{0};
    bool repeats = true;
    std::vector<std::string> ignored;  ///< options without a meaning here
};

/// Up to three numbers, as many as there are.
glm::dvec2 readUpToThree(Cursor& cursor, glm::dvec2 value) {
    for (int i = 0; i < 3; ++i) {
        const Cursor before = cursor;
        double number;
        if (!cursor.number(number)) {
            cursor = before;
            break;
        }
        if (i < 2 && std::abs(number) <= kMostRepeats) value[i] = number;
    }
    return value;
}

MapStatement readMap(Cursor cursor) {
    MapStatement map;
    while (!cursor.atEnd() && *cursor.at == '-') {
        const Cursor before = cursor;
        const std::string option = lowerCase(cursor.word());
        if (option == "-s") {
            // One number alone scales both ways.
            map.scale = readUpToThree(cursor, {1, std::nan("")});
            if (std::isnan(map.scale.y)) map.scale.y = map.scale.x;
        } else if (option == "-o") {
            map.offset = readUpToThree(cursor, {0, 0});
        } else if (option == "-clamp") {
            map.repeats = lowerCase(cursor.word()) != "on";
        } else if (option == "-t") {
            readUpToThree(cursor, {});
            map.ignored.push_back(option);
        } else if (option == "-mm") {
            cursor.word();
            cursor.word();
            map.ignored.push_back(option);
        } else if (option == "-bm" || option == "-boost" || option == "-texres" || option == "-blendu"
            || option == "-blendv" || option == "-cc" || option == "-type" || option == "-imfchan") {
            const std::string value = lowerCase(cursor.word());
            // Alpha is what is taken for holes anyway, and brightness where there is none.
            if (option != "-imfchan" || (value != "m" && value != "l")) map.ignored.push_back(option);
        } else {
            cursor = before;  // a file's name that begins with a dash
            break;
        }
    }
    map.file = cursor.rest();
    return map;
}

/// Reads one library, statement by statement. Keywords count in any case.
class Reader {
public:
    Reader(const std::filesystem::path& folder, MtlFile& into) : folder_(folder), into_(into) {}

    void read(std::string_view text) {
        forEachLine(text, [&](std::string_view line, int number) {
            line_ = number;
            statement({line.data(), line.data() + line.size()});
        });
        finish();
        if (!withoutMeaning_.empty()) {
            const std::vector<std::string> words(withoutMeaning_.begin(), withoutMeaning_.end());
            found_.add(fmt::format("without a meaning in limn: {}; ignored", fmt::join(words, ", ")),
                firstWithoutMeaning_, timesWithoutMeaning_);
        }
        into_.warnings = found_.list();
    }

private:
    void statement(Cursor cursor) {
        const std::string written(cursor.word()), keyword = lowerCase(written);
        if (keyword.empty() || keyword[0] == '#') return;
        if (keyword == "newmtl") {
            finish();
            into_.materials.push_back({.name = std::string(cursor.rest())});
            current_ = {};
        } else if (into_.materials.empty()) {
            warn("material property before the first newmtl; skipped");
        } else if (keyword == "kd") {
            current_.diffuse = readColor(cursor, "Kd");
        } else if (keyword == "ks") {
            current_.specular = readColor(cursor, "Ks");
        } else if (keyword == "ns") {
            if (!cursor.number(current_.exponent) || !std::isfinite(current_.exponent)) current_.exponent = 0;
        } else if (keyword == "d" || keyword == "tr") {
            readOpacity(cursor, keyword == "d");
        } else if (keyword == "map_kd") {
            readImage(cursor, written, false);
        } else if (keyword == "map_d") {
            readImage(cursor, written, true);
        } else if (keyword == "ka" || keyword == "ni" || keyword == "illum" || keyword == "sharpness" || keyword == "tf"
            || keyword == "ke" || keyword == "pr" || keyword == "pm" || keyword == "ps" || keyword == "pc"
            || keyword == "pcr" || keyword == "aniso" || keyword == "anisor") {
            if (timesWithoutMeaning_++ == 0) firstWithoutMeaning_ = line_;
            withoutMeaning_.insert(written);
        } else if (keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" || keyword == "decal"
            || keyword == "refl" || keyword == "norm") {
            warn(fmt::format("{}: limn draws images of map_Kd and map_d alone; ignored", written));
        } else {
            warn(fmt::format("'{}' is no statement of MTL; skipped", written));
        }
    }

    std::optional<Color> readColor(Cursor& cursor, std::string_view what) {
        const Cursor before = cursor;
        const std::string kind = lowerCase(cursor.word());
        if (kind == "spectral") {
            warn(fmt::format("{} spectral names a file of spectra, which limn does not read; ignored", what));
            return {};
        }
        if (kind != "xyz") cursor = before;
        std::array<double, 3> rgb{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (i > 0 && cursor.atEnd())
                rgb[i] = rgb[0];  // one number means grey
            else if (!cursor.number(rgb[i]) || !std::isfinite(rgb[i]))
                rgb[i] = 0;
        }
        if (kind == "xyz") rgb = rgbFromXyz(rgb);
        // Above what rounding makes of 1.
        if (kind != "xyz" && *std::max_element(rgb.begin(), rgb.end()) > 1.001) {
            warn("colour with numbers above 1; taken as 0 to 255");
            for (double& value : rgb) value /= 255;
        }
        const auto channel = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
        return Color{channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
    }

    void readOpacity(Cursor& cursor, bool isDissolve) {
        const Cursor before = cursor;
        if (lowerCase(cursor.word()) != "-halo") cursor = before;
        double value = 0;
        if (!cursor.number(value) || !std::isfinite(value)) return;
        current_.opacityLine = line_;
        if (isDissolve)
            current_.opacity = value;
        else
            current_.transparency = value;
    }

    void readImage(Cursor& cursor, const std::string& keyword, bool isCutout) {
        const MapStatement map = readMap(cursor);
        for (const auto& option : map.ignored) warn(fmt::format("option {} of {}; ignored", option, keyword));
        if (map.file.empty()) return warn(fmt::format("{} names no file; ignored", keyword));
        const NamedFile found = findNamedFile(map.file, folder_);
        if (found.path.empty())
            return warn(fmt::format("texture '{}' is missing{}; drawn without", map.file,
                found.remark.empty() ? "" : fmt::format(" ({})", found.remark)));
        if (!found.remark.empty()) warn(fmt::format("texture '{}' {}", map.file, found.remark));
        Material& material = into_.materials.back();
        (isCutout ? material.cutout : material.texture) = found.path.string();
        // Colours and holes lie in one image: what is said of the colours goes for both.
        if (isCutout && !material.texture.empty()) {
            if (map.scale != material.textureScale || map.offset != material.textureOffset
                || map.repeats != material.textureRepeats)
                warn("map_d with other -s, -o or -clamp than map_Kd; taken as map_Kd's");
            return;
        }
        material.textureScale = map.scale;
        material.textureOffset = map.offset;
        material.textureRepeats = map.repeats;
    }

    /// Ends a material: what its statements mean together.
    void finish() {
        if (into_.materials.empty()) return;
        Material& material = into_.materials.back();
        const Color specular = current_.specular.value_or(Color{});
        material.specular = std::max({specular.r, specular.g, specular.b});
        material.shininess =
            material.specular > 0 ? static_cast<float>(std::clamp(current_.exponent, 0.0, 10000.0)) : 0.0f;
        // Exporters write no colour, or black, for what an image colours.
        const bool isTinted = current_.diffuse && *current_.diffuse != Color{};
        if (!material.texture.empty() && !isTinted)
            material.color = {1, 1, 1};
        else if (current_.diffuse)
            material.color = *current_.diffuse;
        finishOpacity(material);
    }

    void finishOpacity(const Material& material) {
        if (!material.cutout.empty()) return;  // d multiplies the image there, and exporters write 0
        if (current_.opacity && *current_.opacity <= 0) {
            into_.invisible.push_back(material.name);
        } else if (current_.opacity ? *current_.opacity < 1 : current_.transparency > 0) {
            // Scanners write Tr 1 for what is solid.
            found_.add(fmt::format("material '{}' is see-through ({}); drawn solid", material.name,
                           current_.opacity ? fmt::format("d {}", numberText(*current_.opacity))
                                            : fmt::format("Tr {}", numberText(current_.transparency))),
                current_.opacityLine);
        }
    }

    void warn(const std::string& kind) { found_.add(kind, line_); }

    /// What is known of the last material.
    struct State {
        std::optional<Color> diffuse, specular;
        std::optional<double> opacity;
        double exponent = 0, transparency = 0;
        int opacityLine = 0;
    };

    const std::filesystem::path& folder_;
    MtlFile& into_;
    WarningList found_;
    State current_;
    int line_ = 0;
    std::set<std::string> withoutMeaning_;
    int firstWithoutMeaning_ = 0;
    std::size_t timesWithoutMeaning_ = 0;
};

/// The names in an mtllib statement: the line itself may be one name with spaces in it, or several names; a backslash
/// keeps a space within one.
std::vector<std::string> libraryNames(const std::string& line, const std::filesystem::path& folder) {
    const NamedFile whole = findNamedFile(line, folder);
    if (!whole.path.empty() && whole.remark.empty()) return {line};
    std::vector<std::string> names(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool isEscaped = line[i] == '\\' && i + 1 < line.size() && isBlank(line[i + 1]);
        if (isEscaped) ++i;
        if (!isBlank(line[i]) || isEscaped)
            names.back() += line[i];
        else if (!names.back().empty())
            names.emplace_back();
    }
    if (names.back().empty()) names.pop_back();
    const auto isThere = [&](const std::string& name) { return !findNamedFile(name, folder).path.empty(); };
    const bool isOneName = !whole.path.empty() && std::none_of(names.begin(), names.end(), isThere);
    return isOneName ? std::vector<std::string>{line} : names;
}

/// Takes the faces of invisible materials out.
void dropInvisible(const std::vector<std::string>& invisible, PolyMesh& mesh, std::vector<MeshWarning>& warnings) {
    std::vector<char> keep(mesh.faceCount(), 1);
    std::size_t dropped = 0;
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const auto& name = mesh.materialNames[mesh.faceMaterial[f]];
        keep[f] = std::find(invisible.begin(), invisible.end(), name) == invisible.end();
        dropped += !keep[f];
    }
    if (dropped == 0) return;
    warnings.push_back({"face of a material that is not there to be seen (d 0); not drawn", dropped, 0, {}});
    keepFaces(mesh, keep);
}

}  // namespace

MtlFile parseMtl(std::string_view bytes, const std::filesystem::path& folder, const std::string& name) {
    MtlFile file;
    if (bytes.empty()) return file;
    const ModelText decoded(bytes, name);
    Reader(folder, file).read(decoded.text());
    return file;
}

std::vector<Material> readMaterials(const std::filesystem::path& objPath, PolyMesh& mesh,
    std::vector<MeshWarning>& warnings, std::vector<std::filesystem::path>* files) {
    const std::filesystem::path folder = objPath.parent_path();
    std::vector<Material> materials;
    std::vector<std::string> invisible;
    for (const auto& line : mesh.materialLibraries) {
        for (const auto& name : libraryNames(line, folder)) {
            const NamedFile found = findNamedFile(name, folder);
            if (found.path.empty() || !found.remark.empty())
                warnings.push_back(
                    {fmt::format("material library '{}' {}", name,
                         !found.path.empty()        ? found.remark
                             : found.remark.empty() ? "is missing; drawn without"
                                                    : fmt::format("is missing ({}); drawn without", found.remark)),
                        1, 0, {}});
            if (found.path.empty()) continue;
            MtlFile library;
            try {
                library = parseMtl(readFile(found.path), found.path.parent_path(), found.path.string());
            } catch (const Error& error) {
                warnings.push_back(
                    {fmt::format("material library '{}' {}; drawn without", name, error.problem), 1, 0, {}});
                continue;
            }
            if (files) files->push_back(found.path);
            for (auto& warning : library.warnings) {
                warning.file = found.path.string();
                warnings.push_back(std::move(warning));
            }
            std::move(library.materials.begin(), library.materials.end(), std::back_inserter(materials));
            std::move(library.invisible.begin(), library.invisible.end(), std::back_inserter(invisible));
        }
    }
    // One material and not a word about where it goes: it can only be meant for everything.
    if (materials.size() == 1 && !materials[0].name.empty() && mesh.materialNames == std::vector<std::string>{""}) {
        warnings.push_back(
            {fmt::format("no face names a material; all take the library's only one, '{}'", materials[0].name), 1, 0,
                {}});
        mesh.materialNames[0] = materials[0].name;
    }
    if (!invisible.empty()) dropInvisible(invisible, mesh, warnings);
    return materials;
}

}  // namespace limn
