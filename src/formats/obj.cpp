#include "formats/obj.h"
#include "formats/mtl.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "formats/format.h"
#include "formats/model_text.h"
#include "formats/obj_text.h"
#include "settings/color.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <unordered_map>

namespace limn {
namespace {

/// Beyond this the squares and products that shading needs leave float's range.
constexpr double kLargestCoordinate = 1e20;

/// A change of material, part or smoothing, before face `face` of the chunk.
struct StateChange {
    enum class Kind { material, part, smoothing };
    Kind kind;
    std::size_t face;
    std::string name;
    std::uint32_t group;
};

/// What one piece of the file holds; indices that count from its end are not yet resolved.
struct Chunk {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> colors;  ///< of the first positions, as the file has them; the others have none
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> normals;
    struct Corner {
        std::int64_t position;
        std::int32_t uv, normal;
    };
    std::vector<Corner>
        corners;  ///< absolute indices from 0, or relative to the chunk's first element where listed below
    std::vector<std::uint32_t> faceEnd;
    std::vector<int> faceLine;
    std::vector<std::size_t> polylines;  ///< those of the faces that are no faces but `l` elements, ascending
    std::vector<std::uint32_t> relativePosition, relativeUv,
        relativeNormal;  ///< corners whose index is relative to this chunk
    std::vector<StateChange> changes;
    std::vector<std::string> libraries;
    std::vector<std::pair<std::string, int>> tags;  ///< what follows `t`, and its line
    WarningList warnings;
    int lines = 0;
};

const glm::vec3 kNoColor(-1);

constexpr std::int32_t kBadIndex = std::numeric_limits<std::int32_t>::min();

/// One corner "v", "v/t", "v//n" or "v/t/n".
bool readCorner(Cursor& cursor, Chunk& chunk) {
    cursor.skipBlanks();
    const auto index = static_cast<std::uint32_t>(chunk.corners.size());
    const auto resolve = [&](std::int64_t raw, std::size_t count,
                             std::vector<std::uint32_t>& relative) -> std::int64_t {
        if (raw > 0) return raw - 1;
        relative.push_back(index);
        return static_cast<std::int64_t>(count) + raw;
    };
    const auto narrow = [](std::int64_t value) {
        constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
        return value > -most && value < most ? static_cast<std::int32_t>(value) : kBadIndex;
    };
    std::int64_t raw = 0;
    if (!cursor.integer(raw) || raw == 0) return false;
    Chunk::Corner corner{
        resolve(raw, chunk.positions.size(), chunk.relativePosition), PolyMesh::kNone, PolyMesh::kNone};
    if (cursor.at < cursor.end && *cursor.at == '/') {
        ++cursor.at;
        if (cursor.integer(raw))
            corner.uv = raw == 0 ? PolyMesh::kNone : narrow(resolve(raw, chunk.uvs.size(), chunk.relativeUv));
        if (cursor.at < cursor.end && *cursor.at == '/') {
            ++cursor.at;
            if (cursor.integer(raw))
                corner.normal =
                    raw == 0 ? PolyMesh::kNone : narrow(resolve(raw, chunk.normals.size(), chunk.relativeNormal));
        }
    }
    if (cursor.at < cursor.end && !isBlank(*cursor.at)) return false;
    chunk.corners.push_back(corner);
    return true;
}

/// `what`: "face" or "line".
void readFace(Cursor cursor, Chunk& chunk, int line, const char* what = "face") {
    const std::size_t first = chunk.corners.size();
    const std::size_t relative[] = {
        chunk.relativePosition.size(), chunk.relativeUv.size(), chunk.relativeNormal.size()};
    while (!cursor.atEnd()) {
        if (!readCorner(cursor, chunk)) {
            chunk.corners.resize(first);
            chunk.relativePosition.resize(relative[0]);
            chunk.relativeUv.resize(relative[1]);
            chunk.relativeNormal.resize(relative[2]);
            chunk.warnings.add(fmt::format("{} with a corner that is no index; dropped", what), line);
            return;
        }
    }
    chunk.faceEnd.push_back(static_cast<std::uint32_t>(chunk.corners.size()));
    chunk.faceLine.push_back(line);
}

/// What follows a vertex's place: a weight, which means nothing here, or red, green and blue (and perhaps alpha).
void readColor(Cursor& cursor, Chunk& chunk, int line) {
    double rgb[3] = {};
    int count = 0;
    while (count < 3 && cursor.number(rgb[count])) ++count;
    if (count < 3) {
        if (count != 1 || !cursor.atEnd())
            chunk.warnings.add("vertex with something that is neither weight nor colour; drawn without", line);
        return;
    }
    glm::vec3 color(rgb[0], rgb[1], rgb[2]);
    for (int k = 0; k < 3; ++k) {
        if (color[k] >= 0 && color[k] <= 255) continue;
        chunk.warnings.add("vertex colour below 0 or above 255; clamped", line);
        color[k] = color[k] > 255 ? 255.0f : 0.0f;  // also what is no number
    }
    chunk.colors.resize(chunk.positions.size() - 1, kNoColor);
    chunk.colors.push_back(color);
}

void readLine(std::string_view text, int line, Chunk& chunk) {
    Cursor cursor{text.data(), text.data() + text.size()};
    cursor.skipBlanks();
    if (cursor.at == cursor.end || *cursor.at == '#') return;
    const std::string_view keyword = cursor.word();

    const auto numbers = [&](double* out, int required, int optional) {
        for (int i = 0; i < required + optional; ++i) {
            out[i] = 0;
            if (i >= required && cursor.atEnd()) break;
            if (!cursor.number(out[i])) {
                chunk.warnings.add(fmt::format("'{}' line with something that is no number", keyword), line);
                // The element must still exist, or every later index would point one place off; unusable values drop
                // its faces below.
                for (int j = i; j < required; ++j) out[j] = std::numeric_limits<double>::quiet_NaN();
                break;
            }
        }
    };
    double n[4] = {};
    const auto change = [&](StateChange::Kind kind, std::string name, std::uint32_t group) {
        chunk.changes.push_back({kind, chunk.faceEnd.size(), std::move(name), group});
    };
    if (keyword == "v") {
        numbers(n, 3, 0);
        chunk.positions.emplace_back(n[0], n[1], n[2]);
        if (std::isfinite(n[0] + n[1] + n[2]) && !cursor.atEnd()) readColor(cursor, chunk, line);
    } else if (keyword == "vn") {
        numbers(n, 3, 0);
        chunk.normals.emplace_back(n[0], n[1], n[2]);
    } else if (keyword == "vt") {
        numbers(n, 1, 2);
        if (!(std::abs(n[0]) <= kLargestCoordinate && std::abs(n[1]) <= kLargestCoordinate)) {
            chunk.warnings.add("texture coordinate that is no finite place; taken as 0", line);
            n[0] = n[1] = 0;
        }
        chunk.uvs.emplace_back(n[0], n[1]);
    } else if (keyword == "f" || keyword == "fo") {
        readFace(cursor, chunk, line);
    } else if (keyword == "usemtl") {
        change(StateChange::Kind::material, std::string(cursor.rest()), 0);
    } else if (keyword == "o" || keyword == "g") {
        change(StateChange::Kind::part, std::string(cursor.rest()), 0);
    } else if (keyword == "s") {
        const auto group = cursor.rest();
        std::uint32_t value = 0;
        if (group != "off") std::from_chars(group.data(), group.data() + group.size(), value);
        change(StateChange::Kind::smoothing, {}, value);
    } else if (keyword == "mtllib") {
        chunk.libraries.emplace_back(cursor.rest());
    } else if (keyword == "l") {
        const std::size_t before = chunk.faceEnd.size();
        readFace(cursor, chunk, line, "line");
        if (chunk.faceEnd.size() > before) chunk.polylines.push_back(before);
    } else if (keyword == "p") {
        chunk.warnings.add("point element; not drawn", line);
    } else if (keyword == "t") {
        chunk.tags.emplace_back(cursor.rest(), line);
    } else if (keyword == "vp" || keyword == "call" || keyword == "usemap" || keyword == "maplib" || keyword == "lod"
        || keyword == "shadow_obj" || keyword == "trace_obj") {
        // Known statements that say nothing about a polygon picture.
    } else {
        chunk.warnings.add("statement that OBJ does not know; skipped", line);
    }
}

/// Cuts the text into about `count` pieces at line ends that do not continue.
std::vector<std::string_view> split(std::string_view text, std::size_t count) {
    std::vector<std::string_view> pieces;
    const std::size_t target = std::max<std::size_t>(text.size() / std::max<std::size_t>(count, 1), 1);
    while (!text.empty()) {
        std::size_t end = text.size() <= target + target / 2 ? text.size() : target;
        while (end < text.size()) {
            end = text.find('\n', end);
            if (end == std::string_view::npos) {
                end = text.size();
                break;
            }
            const char before = text[end - 1] == '\r' && end >= 2 ? text[end - 2] : text[end - 1];
            ++end;
            if (before != '\\') break;
        }
        pieces.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return pieces;
}

/// Turns a name into a small number, the same for the same name.
struct NameTable {
    std::vector<std::string>& names;
    std::unordered_map<std::string, std::uint32_t> known{};

    std::uint32_t index(const std::string& name) {
        const auto [it, isNew] = known.emplace(name, static_cast<std::uint32_t>(names.size()));
        if (isNew) names.push_back(name);
        return it->second;
    }
};

template <class T, class U>
void append(std::vector<T>& to, std::vector<U>& from) {
    if (to.empty() && std::is_same_v<T, U>)
        to = std::move(from);
    else
        to.insert(to.end(), from.begin(), from.end());
    from = {};
}

class Merger {
public:
    explicit Merger(PolyMesh& mesh) : mesh_(mesh) {}

    void merge(std::vector<Chunk>& chunks, WarningList& warnings) {
        std::size_t corners = 0, faceCount = 0;
        for (const auto& chunk : chunks) {
            corners += chunk.corners.size();
            faceCount += chunk.faceEnd.size();
        }
        std::int64_t positions = 0;
        std::int32_t uvs = 0, normals = 0;
        for (auto& chunk : chunks) {
            for (const auto corner : chunk.relativePosition) chunk.corners[corner].position += positions;
            for (const auto corner : chunk.relativeUv)
                if (chunk.corners[corner].uv != kBadIndex) chunk.corners[corner].uv += uvs;
            for (const auto corner : chunk.relativeNormal)
                if (chunk.corners[corner].normal != kBadIndex) chunk.corners[corner].normal += normals;
            positions += static_cast<std::int64_t>(chunk.positions.size());
            uvs += static_cast<std::int32_t>(chunk.uvs.size());
            normals += static_cast<std::int32_t>(chunk.normals.size());
            if (!chunk.colors.empty()) {
                mesh_.colors.resize(mesh_.positions.size(), kNoColor);
                append(mesh_.colors, chunk.colors);
            }
            append(mesh_.positions, chunk.positions);
            append(mesh_.uvs, chunk.uvs);
            append(mesh_.normals, chunk.normals);
            append(mesh_.materialLibraries, chunk.libraries);
        }
        finishColors(warnings);
        usable_.resize(mesh_.positions.size());
        tbb::parallel_for(std::size_t{0}, mesh_.positions.size(), [&](std::size_t i) {
            const auto& p = mesh_.positions[i];
            const bool usable = std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate
                && std::abs(p.z) <= kLargestCoordinate;
            usable_[i] = usable ? 1 : 0;
        });
        mesh_.faceStart.reserve(faceCount + 1);
        mesh_.cornerPosition.reserve(corners);
        mesh_.cornerUv.reserve(mesh_.uvs.empty() ? 0 : corners);
        mesh_.cornerNormal.reserve(mesh_.normals.empty() ? 0 : corners);
        mesh_.faceMaterial.reserve(faceCount);
        mesh_.facePart.reserve(faceCount);
        mesh_.faceSmoothing.reserve(faceCount);
        int lineBase = 0;
        for (auto& chunk : chunks) {
            addFaces(chunk, lineBase, warnings);
            for (const auto& [kind, warning] : chunk.warnings.kinds)
                warnings.add(kind, lineBase + warning.firstLine, warning.count);
            lineBase += chunk.lines;
            chunk = {};
        }
        addTags(warnings);
    }

    std::size_t outOfRange = 0, faces = 0;
    int firstOutOfRange = 0;

private:
    /// From display-encoded numbers up to 1, or up to 255, to linear ones. Vertices without a colour are white.
    void finishColors(WarningList& warnings) {
        if (mesh_.colors.empty()) return;
        mesh_.colors.resize(mesh_.positions.size(), kNoColor);
        const bool above = std::any_of(mesh_.colors.begin(), mesh_.colors.end(), [](const glm::vec3& c) {
            return std::max({c.r, c.g, c.b}) > 1;
        });
        const bool bytes = above && std::all_of(mesh_.colors.begin(), mesh_.colors.end(), [](const glm::vec3& c) {
            return c == glm::round(c);
        });
        if (above)
            warnings.add(bytes ? "vertex colours are whole numbers above 1; read as 0 to 255"
                               : "vertex colours go above 1; clamped",
                0);
        tbb::parallel_for(std::size_t{0}, mesh_.colors.size(), [&](std::size_t i) {
            glm::vec3& color = mesh_.colors[i];
            if (color == kNoColor)
                color = glm::vec3(1);
            else
                for (int k = 0; k < 3; ++k) color[k] = srgbToLinear(bytes ? color[k] / 255 : std::min(color[k], 1.0f));
        });
    }

    void addFaces(const Chunk& chunk, int lineBase, WarningList& warnings) {
        for (const auto& [text, line] : chunk.tags) tags_.emplace_back(text, lineBase + line);
        std::size_t change = 0, start = 0, polyline = 0;
        for (std::size_t face = 0; face < chunk.faceEnd.size(); ++face) {
            for (; change < chunk.changes.size() && chunk.changes[change].face <= face; ++change)
                applyChange(chunk.changes[change]);
            const std::span corners(chunk.corners.data() + start, chunk.faceEnd[face] - start);
            if (polyline < chunk.polylines.size() && chunk.polylines[polyline] == face) {
                ++polyline;
                addPolyline(corners, lineBase + chunk.faceLine[face], warnings);
            } else {
                addFace(corners, lineBase + chunk.faceLine[face], warnings);
            }
            start = chunk.faceEnd[face];
        }
        for (; change < chunk.changes.size(); ++change) applyChange(chunk.changes[change]);
    }

    void applyChange(const StateChange& change) {
        switch (change.kind) {
            case StateChange::Kind::material: material_ = materials_.index(change.name); break;
            case StateChange::Kind::part: part_ = parts_.index(change.name); break;
            case StateChange::Kind::smoothing: smoothing_ = change.group, mesh_.hasSmoothing = true; break;
        }
    }

    void addFace(std::span<const Chunk::Corner> corners, int line, WarningList& warnings) {
        const std::size_t before = mesh_.faceCount();
        addUsableFace(corners, line, warnings);
        if (mesh_.faceCount() == before) dropped_.push_back(faces);
        ++faces;
    }

    void addPolyline(std::span<const Chunk::Corner> corners, int line, WarningList& warnings) {
        const auto count = static_cast<std::int64_t>(mesh_.positions.size());
        for (const auto& corner : corners) {
            if (corner.position < 0 || corner.position >= count)
                return warnings.add("line refers to a vertex that does not exist; dropped", line);
            if (!usable_[static_cast<std::size_t>(corner.position)])
                return warnings.add("line with a vertex that is no finite place; dropped", line);
        }
        const std::size_t before = mesh_.lines.size();
        useNames();
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
            const glm::dvec3 a = mesh_.positions[static_cast<std::size_t>(corners[i].position)],
                             b = mesh_.positions[static_cast<std::size_t>(corners[i + 1].position)];
            if (a != b) mesh_.lines.push_back({a, b, material_, part_});
        }
        if (mesh_.lines.size() == before) warnings.add("line without length; dropped", line);
    }

    /// What comes before any `usemtl` or `o` has no name.
    void useNames() {
        if (material_ == kUnset) material_ = materials_.index("");
        if (part_ == kUnset) part_ = parts_.index("");
    }

    void addUsableFace(std::span<const Chunk::Corner> corners, int line, WarningList& warnings) {
        const auto count = static_cast<std::int64_t>(mesh_.positions.size());
        for (const auto& corner : corners) {
            if (corner.position < 0 || corner.position >= count) {
                if (outOfRange++ == 0) firstOutOfRange = line;
                return warnings.add("face refers to a vertex that does not exist; dropped", line);
            }
            if (!usable_[static_cast<std::size_t>(corner.position)])
                return warnings.add("face with a vertex that is no finite place; dropped", line);
        }
        const std::size_t first = mesh_.cornerPosition.size();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto& corner = corners[i];
            if (corner.position == corners[i == 0 ? corners.size() - 1 : i - 1].position && corners.size() > 1) {
                warnings.add("face repeats a vertex; repetition dropped", line);
                continue;
            }
            mesh_.cornerPosition.push_back(static_cast<std::uint32_t>(corner.position));
            if (!mesh_.uvs.empty())
                mesh_.cornerUv.push_back(checked(corner.uv, mesh_.uvs.size(), "texture coordinate", line, warnings));
            if (!mesh_.normals.empty())
                mesh_.cornerNormal.push_back(checked(corner.normal, mesh_.normals.size(), "normal", line, warnings));
        }
        if (mesh_.cornerPosition.size() - first < 3) {
            mesh_.cornerPosition.resize(first);
            if (!mesh_.uvs.empty()) mesh_.cornerUv.resize(first);
            if (!mesh_.normals.empty()) mesh_.cornerNormal.resize(first);
            return warnings.add("face with fewer than three corners; dropped", line);
        }
        mesh_.faceStart.push_back(static_cast<std::uint32_t>(mesh_.cornerPosition.size()));
        useNames();
        mesh_.faceMaterial.push_back(material_);
        mesh_.facePart.push_back(part_);
        mesh_.faceSmoothing.push_back(smoothing_);
    }

    static std::int32_t checked(
        std::int32_t index, std::size_t count, const char* what, int line, WarningList& warnings) {
        if (index == PolyMesh::kNone) return index;
        if (index >= 0 && static_cast<std::size_t>(index) < count) return index;
        warnings.add(fmt::format("face refers to a {} that does not exist; done without", what), line);
        return PolyMesh::kNone;
    }

    /// One tag: NAME integers/floats/strings, then as many of each.
    void addTag(const std::string& text, int line, WarningList& warnings) {
        Cursor cursor{text.data(), text.data() + text.size()};
        const auto name = cursor.word();
        std::int64_t counts[3] = {};
        cursor.skipBlanks();
        for (int i = 0; i < 3; ++i) {
            if (!cursor.integer(counts[i]) || counts[i] < 0 || counts[i] > static_cast<std::int64_t>(text.size()))
                return warnings.add("subdivision tag that cannot be read; skipped", line);
            if (i < 2 && (cursor.at == cursor.end || *cursor.at++ != '/'))
                return warnings.add("subdivision tag that cannot be read; skipped", line);
        }
        std::vector<std::int64_t> integers;
        std::vector<float> floats;
        std::string word;
        for (std::int64_t i = 0; i < counts[0]; ++i) {
            cursor.skipBlanks();
            if (std::int64_t value; cursor.integer(value)) integers.push_back(value);
        }
        for (std::int64_t i = 0; i < counts[1]; ++i)
            if (double value; cursor.number(value)) floats.push_back(static_cast<float>(value));
        if (counts[2] > 0) word = cursor.word();
        const bool complete = static_cast<std::int64_t>(integers.size()) == counts[0]
            && static_cast<std::int64_t>(floats.size()) == counts[1];
        const bool hasFloat =
            std::find_if(floats.begin(), floats.end(), [](float f) { return !(f >= 0); }) == floats.end()
            && !floats.empty();
        const auto isVertex = [&](std::int64_t v) {
            return v >= 0 && static_cast<std::size_t>(v) < mesh_.positions.size();
        };
        const auto choice = [&](int most) -> std::optional<int> {
            if (integers.size() == 1 && integers[0] >= 0 && integers[0] <= most) return static_cast<int>(integers[0]);
            warnings.add("subdivision tag that cannot be read; skipped", line);
            return std::nullopt;
        };
        SubdivisionTags& tags = mesh_.tags;
        if (!complete) return warnings.add("subdivision tag that cannot be read; skipped", line);
        if (name == "crease") {
            if (integers.size() < 2 || !hasFloat)
                return warnings.add("subdivision tag that cannot be read; skipped", line);
            for (std::size_t i = 0; i + 1 < integers.size(); ++i) {
                if (!isVertex(integers[i]) || !isVertex(integers[i + 1]))
                    warnings.add("crease or corner at a vertex that does not exist; skipped", line);
                else
                    tags.creases.push_back({static_cast<std::uint32_t>(integers[i]),
                        static_cast<std::uint32_t>(integers[i + 1]), floats[std::min(i, floats.size() - 1)]});
            }
        } else if (name == "corner") {
            if (integers.empty() || !hasFloat)
                return warnings.add("subdivision tag that cannot be read; skipped", line);
            for (std::size_t i = 0; i < integers.size(); ++i) {
                if (!isVertex(integers[i]))
                    warnings.add("crease or corner at a vertex that does not exist; skipped", line);
                else
                    tags.corners.push_back(
                        {static_cast<std::uint32_t>(integers[i]), floats[std::min(i, floats.size() - 1)]});
            }
        } else if (name == "hole") {
            for (const auto face : integers) {
                if (face < 0 || static_cast<std::size_t>(face) >= faces) {
                    warnings.add("hole in a face that does not exist; skipped", line);
                    continue;
                }
                const auto at = std::lower_bound(dropped_.begin(), dropped_.end(), static_cast<std::size_t>(face));
                if (at == dropped_.end() || *at != static_cast<std::size_t>(face))
                    tags.holes.push_back(static_cast<std::uint32_t>(face - (at - dropped_.begin())));
            }
        } else if (name == "interpolateboundary") {
            tags.boundary = choice(2);
        } else if (name == "facevaryinginterpolateboundary") {
            tags.faceVaryingBoundary = choice(5);
        } else if (name == "creasemethod" && (word == "normal" || word == "chaikin")) {
            tags.chaikin = word == "chaikin";
        } else if (name == "smoothtriangles" && (word == "catmark" || word == "smooth")) {
            tags.smoothTriangles = word == "smooth";
        } else if (name == "vertexedit" || name == "edgeedit" || name == "faceedit") {
            warnings.add("hierarchical edit; not applied", line);
        } else if (name != "facevaryingpropagatecorners") {
            warnings.add("subdivision tag that is not known; skipped", line);
        }
    }

    void addTags(WarningList& warnings) {
        for (const auto& [text, line] : tags_) addTag(text, line, warnings);
        auto& holes = mesh_.tags.holes;
        std::sort(holes.begin(), holes.end());
        holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
    }

    static constexpr std::uint32_t kUnset = ~0u;
    PolyMesh& mesh_;
    std::vector<std::pair<std::string, int>> tags_;
    std::vector<std::size_t> dropped_;  // numbers of faces in the file that were not usable, ascending
    NameTable materials_{mesh_.materialNames}, parts_{mesh_.partNames};
    std::uint32_t material_ = kUnset, part_ = kUnset, smoothing_ = 0;
    std::vector<char> usable_;
};

}  // namespace

/// Are there vertices written like "v 0,5 1,0 2,25", as some programs do in some countries?
static bool hasDecimalCommas(std::string_view text) {
    bool found = false;
    forEachLine(text.substr(0, 1 << 16), [&](std::string_view line, int) {
        Cursor cursor{line.data(), line.data() + line.size()};
        found = found || (cursor.word() == "v" && cursor.word().find(',') != std::string_view::npos);
    });
    return found;
}

ObjFile parseObj(std::string_view bytes, const std::string& name, int chunkCount) {
    const ModelText decoded(bytes, name);
    const std::string_view text = decoded.text();
    // Pieces of a megabyte keep every core busy without costing small files anything.
    const auto pieces = split(text,
        chunkCount > 0 ? static_cast<std::size_t>(chunkCount) : std::clamp<std::size_t>(text.size() >> 20, 1, 256));
    std::vector<Chunk> chunks(pieces.size());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
        chunks[i].lines =
            forEachLine(pieces[i], [&](std::string_view line, int number) { readLine(line, number, chunks[i]); });
    });

    ObjFile file;
    WarningList warnings;
    Merger merger(file.mesh);
    merger.merge(chunks, warnings);
    if (merger.outOfRange * 2 > merger.faces)
        throw Error(ExitCode::badData, {name, merger.firstOutOfRange},
            fmt::format("{} of {} faces refer to vertices that do not exist", merger.outOfRange, merger.faces),
            "the file is damaged or cut off: export it again");
    if (file.mesh.faceCount() == 0 && merger.faces > 0) {
        if (hasDecimalCommas(text))
            throw Error(ExitCode::badData, {name}, "the numbers have decimal commas", "export with decimal points");
        throw Error(ExitCode::badData, {name}, "no face is usable", "export the model again");
    }
    file.warnings = warnings.list();
    return file;
}

ObjFile readObj(const std::filesystem::path& path) { return parseObj(MappedFile(path).text(), path.string()); }

static MeshFile readMesh(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    // Lines of text become about four times as many bytes: chunks first, then the mesh.
    const MemoryClaim claim(mapped.text().size() * 4, {path.string()},
        fmt::format("the file has {}", bytesText(mapped.text().size())), "split the model into several files");
    MeshFile file;
    tbb::parallel_invoke([&] { file.key = contentKey(mapped.text()); },
        [&] {
            ObjFile obj = parseObj(mapped.text(), path.string());
            file.poly = std::move(obj.mesh);
            file.warnings = std::move(obj.warnings);
        });
    file.files.push_back(path);
    const std::size_t faces = file.poly.faceCount();
    file.materials = readMaterials(path, file.poly, file.warnings, &file.files);
    if (file.poly.faceCount()
        != faces) {  // a library has taken faces away: the same OBJ beside another is another mesh
        const auto& corners = file.poly.cornerPosition;
        KeyBuilder key;
        file.key =
            key.add(file.key.low).add(file.key.high).bytes(corners.data(), corners.size() * sizeof corners[0]).key();
    }
    return file;
}

const MeshFormat kObj{".obj", "Wavefront OBJ with MTL, vertex colours and OpenSubdiv's t tags", readMesh};

}  // namespace limn
