#include "stage/loaded_scene.h"

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "formats/creases.h"
#include "image/texture.h"
#include "mesh/topology.h"
#include "stage/edge_rates.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

namespace limn {
namespace {

/// Box of the vertices that faces and lines use, transformed one by one: the box of a turned box would be too large.
Bounds instanceBounds(const PolyMesh& mesh, const glm::dmat4& worldFromMesh) {
    Bounds bounds;
    const bool identity = worldFromMesh == glm::dmat4(1);
    for (const auto v : mesh.cornerPosition)
        bounds.add(identity ? mesh.positions[v] : glm::dvec3(worldFromMesh * glm::dvec4(mesh.positions[v], 1)));
    for (const auto& line : mesh.lines)
        for (const auto& end : {line.a, line.b}) bounds.add(glm::dvec3(worldFromMesh * glm::dvec4(end, 1)));
    return bounds;
}

/// Leaves of a mesh what its source asks for. Throws Error where a pattern fits no part.
void chooseParts(const MeshSource& source, PolyMesh& mesh) {
    if (source.parts.empty() && source.withoutParts.empty()) return;
    const auto fitsAny = [](const std::vector<std::string>& patterns, const std::string& part) {
        return std::any_of(
            patterns.begin(), patterns.end(), [&](const auto& pattern) { return fitsPattern(pattern, part); });
    };
    for (const auto& patterns : {source.parts, source.withoutParts})
        for (const auto& pattern : patterns)
            if (std::none_of(mesh.partNames.begin(), mesh.partNames.end(),
                    [&](const auto& part) { return fitsPattern(pattern, part); }))
                throw Error(ExitCode::usage, source.where,
                    fmt::format("no part of '{}' is named '{}'", source.file, pattern),
                    nameRemedy(pattern, mesh.partNames));
    const auto isKept = [&](std::uint32_t part) {
        const std::string& name = mesh.partNames[part];
        return (source.parts.empty() || fitsAny(source.parts, name)) && !fitsAny(source.withoutParts, name);
    };
    std::vector<char> keep(mesh.faceCount());
    for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = isKept(mesh.facePart[f]) ? 1 : 0;
    keepFaces(mesh, keep);
    std::erase_if(mesh.lines, [&](const MeshLine& line) { return !isKept(line.part); });
}

/// Reads one mesh and its tags and materials.
MeshFile readMesh(const MeshSource& source, int frame) {
    const std::filesystem::path path = source.at(frame);
    MeshFile mesh = meshFormat(path).read(path);
    KeyBuilder key;
    key.add(mesh.key.low).add(mesh.key.high);
    chooseParts(source, mesh.poly);
    for (const auto& patterns : {source.parts, source.withoutParts}) {
        key.add(patterns.size());
        for (const auto& pattern : patterns) key.add(pattern);
    }
    if (!source.creases.empty()) {
        std::vector<std::filesystem::path> sidecar;
        readCreases(source.creases, mesh.poly, &sidecar);
        for (const auto& file : sidecar) key.add(MappedFile(file).text());
        mesh.files.insert(mesh.files.end(), sidecar.begin(), sidecar.end());
    }
    const auto note = [&](std::string_view kind, std::size_t count) {
        if (count == 0) return;
        MeshWarning& warning = mesh.warnings.emplace_back();
        warning.kind = kind;
        warning.count = count;
    };
    // An animation may begin or end with nothing.
    if (!source.perFrame) requireFaces(mesh);
    note("there are no faces; an empty frame", mesh.poly.faceCount() == 0 && mesh.poly.lines.empty());
    const bool welds = source.subdivision.present && source.subdivision.weld;
    const bool repairs = source.subdivision.present || mesh.poly.cornerNormal.empty();
    if (welds)
        note("vertex in the place of another one on the rim; joined (weld = false keeps them apart)",
            joinSeams(mesh.poly));
    if (repairs)
        repairTopology(mesh.poly, mesh.warnings);
    else
        turnNormals(mesh.poly, mesh.warnings);
    mesh.key = key.add(repairs).add(welds).key();
    for (const auto& p : mesh.poly.positions) mesh.bounds.add(p);
    return mesh;
}

/// Lets a texture's alpha mask cut holes too, since exporters name a leaf's image once. For materials of mesh files
/// only: a scene names its cutouts itself.
class AlphaMasks {
public:
    void adopt(MeshFile& mesh) {
        std::vector<Error> told;  // by whoever draws or checks the image
        for (auto& material : mesh.materials)
            collect(told, [&] {
                if (material.cutout.empty() && !material.texture.empty() && isMask(material.texture))
                    material.cutout = material.texture;
            });
    }

private:
    /// Looks at each image once, and at one at a time: it is decoded for that.
    bool isMask(const std::string& file) {
        const std::lock_guard lock(mutex_);
        const auto [known, isNew] = known_.try_emplace(file, false);
        if (isNew) known->second = isAlphaMask(file);
        return known->second;
    }

    std::mutex mutex_;
    std::map<std::string, bool> known_;
};

void warnOf(const MeshFile& mesh) {
    for (const auto& warning : mesh.warnings)
        log::warning("{}{}: {}{}", warning.file.empty() ? mesh.files.front().string() : warning.file,
            warning.firstLine > 0 ? fmt::format(":{}", warning.firstLine) : "", warning.kind,
            warning.count > 1 ? fmt::format(" ({} times)", warning.count) : "");
}

/// Warns of materials that a mesh's faces ask for and nobody has.
void warnOfMaterials(const MeshFile& mesh, const Scene& scene) {
    if (mesh.materials.empty()) return;  // no library, or one already reported missing
    std::vector<std::string> known, ofScene;
    for (const auto& material : mesh.materials) known.push_back(material.name);
    for (const auto& material : scene.materials) ofScene.push_back(material.base.name);
    const auto has = [](const auto& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const auto& name : mesh.poly.materialNames)
        if (!name.empty() && !has(known, name) && !has(ofScene, name))
            log::warning("{}: material '{}' is in no library ({}); drawn paper grey", mesh.files.front().string(), name,
                nameRemedy(name, known));
}

void addImage(ImageKeys& keys, const std::string& file) {
    if (!file.empty() && !keys.contains(file)) keys[file] = contentKey(MappedFile(file).text());
}

}  // namespace

struct MeshLibrary::State {
    struct Entry {
        int frame;  ///< of a mesh with a file for each; else 0
        SharedMesh mesh;
    };
    std::vector<MeshSource> sources;
    std::vector<bool> isDrawn;
    std::mutex mutex;
    std::vector<std::vector<Entry>> entries;  ///< of each source, in the order in which they were read
    ImageKeys images;
    AlphaMasks masks;

    int frameOf(std::size_t source, int frame) const { return sources[source].numberAt(frame); }

    SharedMesh find(std::size_t source, int frame) const {
        for (const auto& entry : entries[source])
            if (entry.frame == frameOf(source, frame)) return entry.mesh;
        return nullptr;
    }

    /// Reads these meshes at a frame, in parallel. If one fails, none is kept.
    void read(const std::vector<std::size_t>& wanted, int frame) {
        std::vector<MeshFile> meshes(wanted.size());
        std::vector<ImageKeys> shown(wanted.size());
        std::vector<std::vector<Error>> failed(wanted.size());
        tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t w) {
            collect(failed[w], [&] {
                meshes[w] = readMesh(sources[wanted[w]], frame);
                masks.adopt(meshes[w]);
                for (const auto& material : meshes[w].materials)
                    for (const auto& image : {material.texture, material.cutout}) addImage(shown[w], image);
            });
        });
        ErrorCollector errors;
        for (const auto& list : failed)
            for (const auto& error : list) errors.add(error);
        errors.throwIfAny();
        for (std::size_t w = 0; w < wanted.size(); ++w) {
            warnOf(meshes[w]);
            images.merge(shown[w]);
            auto& kept = entries[wanted[w]];
            constexpr std::size_t kMost = 2;
            if (kept.size() == kMost) kept.erase(kept.begin());
            kept.push_back({frameOf(wanted[w], frame), std::make_shared<const MeshFile>(std::move(meshes[w]))});
        }
    }
};

MeshLibrary::MeshLibrary(std::vector<MeshSource> sources, std::vector<bool> isDrawn)
    : state_(std::make_unique<State>()) {
    state_->entries.resize(sources.size());
    state_->sources = std::move(sources);
    state_->isDrawn = std::move(isDrawn);
}

MeshLibrary::~MeshLibrary() = default;

std::vector<SharedMesh> MeshLibrary::at(int frame) const {
    const std::lock_guard lock(state_->mutex);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < state_->sources.size(); ++i)
        if (state_->isDrawn[i] && !state_->find(i, frame)) missing.push_back(i);
    state_->read(missing, frame);
    std::vector<SharedMesh> meshes;
    for (std::size_t i = 0; i < state_->sources.size(); ++i) meshes.push_back(state_->find(i, frame));
    return meshes;
}

ImageKeys MeshLibrary::imageKeys() const {
    const std::lock_guard lock(state_->mutex);
    return state_->images;
}

std::vector<std::filesystem::path> MeshLibrary::files() const {
    const std::lock_guard lock(state_->mutex);
    std::set<std::filesystem::path> files;
    for (const auto& entries : state_->entries)
        for (const auto& entry : entries) files.insert(entry.mesh->files.begin(), entry.mesh->files.end());
    for (const auto& [file, key] : state_->images) files.insert(file);
    return {files.begin(), files.end()};
}

std::size_t meshIndex(const Scene& scene, const std::string& name) {
    const auto isNamed = [&](const auto& mesh) { return mesh.name == name; };
    return static_cast<std::size_t>(
        std::find_if(scene.meshes.begin(), scene.meshes.end(), isNamed) - scene.meshes.begin());
}

std::optional<SubdivisionOptions> subdivisionOf(const MeshSource& source, const PolyMesh& mesh) {
    const SubdivisionSettings& settings = source.subdivision;
    if (!settings.present) return std::nullopt;
    SubdivisionOptions options;
    options.scheme = static_cast<SubdivisionScheme>(settings.scheme);
    options.level = settings.level;
    options.limit = settings.limit;
    options = withTags(options, mesh.tags);
    if (settings.boundary != BoundaryName::file)
        options.boundary = static_cast<BoundaryRule>(static_cast<int>(settings.boundary) - 1);
    if (settings.uvBoundary != UvBoundaryName::file)
        options.uv = static_cast<UvRule>(static_cast<int>(settings.uvBoundary) - 1);
    if (settings.creaseMethod != CreaseMethodName::file)
        options.chaikin = settings.creaseMethod == CreaseMethodName::chaikin;
    return options;
}

/// The meshes of the first declared frame; where a file of its own is unusable, those of the first frame that has none
/// such: a bad file is its frame's affair. Throws Errors.
static std::vector<SharedMesh> firstMeshes(const LoadedScene& loaded) {
    const auto isOfFrame = [&](const Error& error, int frame) {
        return std::any_of(loaded.scene.meshes.begin(), loaded.scene.meshes.end(),
            [&](const auto& mesh) { return mesh.perFrame && mesh.at(frame) == error.where.file; });
    };
    const int first = loaded.scene.firstFrame(), last = loaded.scene.frames ? loaded.scene.frames->last : first;
    for (int frame = first;; ++frame) {
        std::vector<SharedMesh> meshes;
        std::vector<Error> failed;
        collect(failed, [&] { meshes = loaded.meshes->at(frame); });
        if (failed.empty()) return meshes;
        const bool mayGoOn = frame < last
            && std::all_of(failed.begin(), failed.end(), [&](const Error& error) { return isOfFrame(error, frame); });
        if (mayGoOn) continue;
        ErrorCollector errors;
        for (auto& error : failed) errors.add(std::move(error));
        errors.throwIfAny();
    }
}

/// Scans, CAD and maps count z upwards: such a model stands on z = 0, and goes through y = 0.
static void hintAtUp(const LoadedScene& loaded) {
    const Bounds& box = loaded.bounds;
    if (box.empty()) return;
    const glm::dvec3 size = box.hi - box.lo;
    if (std::abs(box.lo.z) < 0.03 * size.z && box.lo.y < -0.03 * size.y)
        log::info("{}: y is taken for up, but the model stands on z = 0: where it lies on its back, add --up z",
            loaded.scene.file);
}

/// The box of everything that is drawn at a frame.
static Bounds boundsAt(const LoadedScene& loaded, int frame, const std::vector<SharedMesh>& meshes) {
    Bounds bounds;
    for (const auto& instance : loaded.scene.instances) {
        const Instance placed = instance.at(frame);
        if (!placed.visible) continue;
        bounds.add(
            instanceBounds(meshes[meshIndex(loaded.scene, placed.mesh)]->poly, loaded.scene.worldFrom(placed, frame)));
    }
    return bounds;
}

LoadedScene loadScene(const std::filesystem::path& path, const MeshFileOptions& options) {
    LoadedScene loaded;
    loaded.viewers = makeEdgeViewers();
    if (isMeshFile(path)) {
        loaded.scene = sceneOfMesh(path);
        loaded.scene.up = options.up.value_or(Axis::y);
        if (options.subdivide) loaded.scene.meshes.front().subdivision = {.present = true, .level = *options.subdivide};
    } else {
        if (options.subdivide)
            throw Error(ExitCode::usage, {path.string()},
                "--subdivide is for mesh files; a scene says itself what is subdivided",
                "write subdivision = { level = 2 } under its [[mesh]]");
        if (options.up)
            throw Error(ExitCode::usage, {path.string()},
                "--up is for mesh files; a scene says itself which axis points up", "write up = \"z\" into it");
        SceneFile file = sceneFormat(path).read(path);
        loaded.scene = std::move(file.scene);
        loaded.files = std::move(file.files);
    }
    std::vector<bool> isDrawn(loaded.scene.meshes.size());
    for (const auto& instance : loaded.scene.instances) isDrawn[meshIndex(loaded.scene, instance.base.mesh)] = true;
    loaded.meshes = std::make_shared<const MeshLibrary>(loaded.scene.meshes, std::move(isDrawn));

    const int first = loaded.scene.firstFrame();
    const auto meshes = firstMeshes(loaded);
    for (const auto& mesh : meshes)
        if (mesh) warnOfMaterials(*mesh, loaded.scene);
    loaded.bounds = boundsAt(loaded, first, meshes);
    // An animation may begin with nothing.
    const int last = loaded.scene.frames ? loaded.scene.frames->last : first;
    std::vector<Error> failed;  // told by whoever draws that frame
    for (int frame = first + 1; frame <= last && loaded.bounds.empty(); ++frame)
        collect(failed, [&] { loaded.bounds = boundsAt(loaded, frame, loaded.meshes->at(frame)); });

    KeyBuilder key;
    for (const auto& file : loaded.files) key.add(MappedFile(file).text());
    if (options.subdivide) key.add(*options.subdivide);
    if (options.up) key.add(*options.up);
    if (isMeshFile(path) && !options.up) hintAtUp(loaded);
    for (const auto& material : loaded.scene.materials)
        for (const auto& image : {material.base.texture, material.base.cutout}) addImage(loaded.images, image);
    for (const auto& [file, image] : loaded.images) {
        key.add(image.low).add(image.high);
        loaded.files.emplace_back(file);
    }
    // Decides the camera, relative lengths and precision at every frame.
    for (const auto& corner : {loaded.bounds.lo, loaded.bounds.hi}) key.add(corner.x).add(corner.y).add(corner.z);
    loaded.key = key.key();
    return loaded;
}

}  // namespace limn
