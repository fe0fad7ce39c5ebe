#include "render/loader.h"

#include "base/file.h"
#include "base/log.h"
#include "base/text.h"
#include "geometry/topology.h"
#include "scene/creases.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <map>

namespace limn {
namespace {

bool isObj(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".obj";
}

/// Box of the vertices that faces use, transformed one by one: the box of a turned box would be too large.
Bounds instanceBounds(const PolyMesh& mesh, const glm::dmat4& worldFromMesh) {
    Bounds bounds;
    const bool identity = worldFromMesh == glm::dmat4(1);
    for (const auto v : mesh.cornerPosition)
        bounds.add(identity ? mesh.positions[v] : glm::dvec3(worldFromMesh * glm::dvec4(mesh.positions[v], 1)));
    return bounds;
}

/// Gives every material that an instance may show a number; 0 is the default.
class MaterialTable {
public:
    MaterialTable(const LoadedScene& loaded, double frame) : loaded_(loaded) {
        materials.push_back({.name = ""});
        for (const auto& material : loaded.scene.materials) byName_[material.base.name] = add(material.at(frame));
    }

    std::uint32_t named(const std::string& name) const { return byName_.at(name); }

    /// Of a mesh's own material: the scene's of that name, else the MTL's, else the default.
    std::uint32_t ofMesh(std::size_t mesh, const std::string& name) {
        if (const auto it = byName_.find(name); it != byName_.end()) return it->second;
        const auto [it, isNew] = byMesh_.emplace(std::pair(mesh, name), 0);
        if (isNew)
            for (const auto& material : loaded_.meshes[mesh].materials)
                if (material.name == name) it->second = add(material);
        // Colours of vertices are all the colour there is, where no material says more.
        if (isNew && it->second == 0 && !loaded_.meshes[mesh].poly.colors.empty())
            it->second = add({.name = name, .color = {1, 1, 1}});
        return it->second;
    }

    std::vector<Material> materials;

private:
    std::uint32_t add(Material material) {
        materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(materials.size() - 1);
    }

    const LoadedScene& loaded_;
    std::map<std::string, std::uint32_t> byName_;
    std::map<std::pair<std::size_t, std::string>, std::uint32_t> byMesh_;
};

/// Reads one mesh and what belongs to it; returns the hash of it all.
std::uint64_t readMesh(LoadedMesh& mesh, const MeshSource& source, int frame) {
    const std::filesystem::path path = source.at(frame);
    const MappedFile file(path);
    auto obj = parseObj(file.text(), path.string());
    mesh = {std::move(obj.mesh), {}, std::move(obj.warnings)};
    mesh.materials = readMaterials(path, mesh.poly, mesh.warnings);
    if (!source.creases.empty()) readCreases(source.creases, mesh.poly);
    if (source.subdivision.present || mesh.poly.cornerNormal.empty()) repairTopology(mesh.poly, mesh.warnings);
    // Size and a sample of the text: reading every byte again would cost as much as parsing it.
    Hash hash;
    hash.add(std::to_string(file.text().size()));
    constexpr std::size_t kPiece = 4096, kPieces = 64;
    const std::size_t stride = std::max(kPiece, file.text().size() / kPieces);
    for (std::size_t at = 0; at < file.text().size(); at += stride) hash.add(file.text().substr(at, kPiece));
    for (const auto& material : mesh.materials) {
        hash.add(fmt::format("{} {} {} {} {} {}", material.name, material.color.r, material.color.g, material.color.b,
            material.shininess, material.specular));
        for (const auto& image : {material.texture, material.cutout})
            if (!image.empty()) hash.add(MappedFile(image).text());
    }
    if (!source.creases.empty()) hash.add(MappedFile(source.creases).text());
    return hash.value();
}

/// Reads these meshes, in parallel. All problems at once (Errors).
void readMeshes(LoadedScene& loaded, const std::vector<std::size_t>& wanted) {
    const auto& sources = loaded.scene.meshes;
    std::vector<std::vector<Error>> failed(wanted.size());
    tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t w) {
        const std::size_t i = wanted[w];
        try {
            loaded.meshHashes[i] = readMesh(loaded.meshes[i], sources[i], loaded.frame);
        } catch (const Error& error) { failed[w].push_back(error); } catch (const Errors& list) {
            failed[w] = list.list;
        }
    });
    ErrorCollector errors;
    for (const auto& list : failed)
        for (const auto& error : list) errors.add(error);
    errors.throwIfAny();
    for (const std::size_t i : wanted)
        for (const auto& warning : loaded.meshes[i].warnings)
            log::warning("{}{}: {}{}", sources[i].at(loaded.frame).string(),
                warning.firstLine > 0 ? fmt::format(":{}", warning.firstLine) : "", warning.kind,
                warning.count > 1 ? fmt::format(" ({} times)", warning.count) : "");
}

void combineHashes(LoadedScene& loaded) {
    Hash hash;
    hash.add(&loaded.sceneHash, sizeof loaded.sceneHash);
    for (const auto value : loaded.meshHashes) hash.add(&value, sizeof value);
    loaded.hash = hash.hex();
}

std::uint64_t nextSceneNumber() {
    static std::atomic<std::uint64_t> count = 0;
    return ++count;
}

}  // namespace

std::size_t meshIndex(const Scene& scene, const std::string& name) {
    const auto it =
        std::find_if(scene.meshes.begin(), scene.meshes.end(), [&](const auto& mesh) { return mesh.name == name; });
    return static_cast<std::size_t>(it - scene.meshes.begin());
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

void finishLoading(LoadedScene& loaded) {
    loaded.number = nextSceneNumber();
    loaded.bounds = {};
    const double first = loaded.scene.firstFrame();
    for (const auto& instance : loaded.scene.instances) {
        const Instance placed = instance.at(first);
        loaded.bounds.add(instanceBounds(loaded.meshes[meshIndex(loaded.scene, placed.mesh)].poly, placed.transform()));
    }
}

void goToFrame(LoadedScene& loaded, int frame) {
    if (frame == loaded.frame) return;
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < loaded.meshes.size(); ++i)
        if (loaded.scene.meshes[i].perFrame && loaded.meshes[i].poly.faceCount() > 0) wanted.push_back(i);
    // Should a file be bad, the scene stays where it was.
    std::vector<LoadedMesh> before;
    const auto hashes = loaded.meshHashes;
    const int frameBefore = loaded.frame;
    for (const auto i : wanted) before.push_back(std::move(loaded.meshes[i]));
    loaded.frame = frame;
    try {
        readMeshes(loaded, wanted);
    } catch (...) {
        for (std::size_t w = 0; w < wanted.size(); ++w) loaded.meshes[wanted[w]] = std::move(before[w]);
        loaded.meshHashes = hashes;
        loaded.frame = frameBefore;
        throw;
    }
    if (wanted.empty()) return;
    combineHashes(loaded);
    loaded.number = nextSceneNumber();
}

LoadedScene loadScene(const std::filesystem::path& path) { return loadScene(RenderConfig{.scene = path}); }

LoadedScene loadScene(const RenderConfig& config) {
    const std::filesystem::path& path = config.scene;
    LoadedScene loaded;
    std::vector<std::filesystem::path> files;
    if (isObj(path))
        loaded.scene = sceneFromObj(path);
    else
        loaded.scene = readScene(path, &files);
    if (config.subdivide && !isObj(path))
        throw Error(ExitCode::usage, {path.string()},
            "--subdivide is for OBJ files; a scene says itself what is subdivided",
            "write subdivision = { level = 2 } under its [[mesh]]");
    if (config.subdivide) loaded.scene.meshes.front().subdivision = {.present = true, .level = *config.subdivide};

    const auto& meshes = loaded.scene.meshes;
    loaded.meshes.resize(meshes.size());
    std::vector<bool> drawn(meshes.size());
    for (const auto& instance : loaded.scene.instances) drawn[meshIndex(loaded.scene, instance.base.mesh)] = true;

    loaded.frame = loaded.scene.firstFrame();
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        if (drawn[i]) wanted.push_back(i);
    loaded.meshHashes.resize(meshes.size());
    readMeshes(loaded, wanted);

    Hash hash;
    for (const auto& file : files) hash.add(readFile(file));
    for (const auto& material : loaded.scene.materials)
        for (const auto& image : {material.base.texture, material.base.cutout})
            if (!image.empty()) hash.add(MappedFile(image).text());
    loaded.sceneHash = hash.value();
    combineHashes(loaded);
    finishLoading(loaded);
    return loaded;
}

/// The number of what an object and its material say about lines; the object goes first.
static std::uint32_t lineRecord(DrawScene& scene, const Instance& object, const Material& material) {
    const LineOverride both{object.lines && material.lines,
        object.lineColor.given ? object.lineColor : material.lineColor,
        object.creaseAngle > 0 ? object.creaseAngle : material.creaseAngle, material.isCut};
    const auto known = std::find(scene.lineRecords.begin(), scene.lineRecords.end(), both);
    if (known != scene.lineRecords.end()) return static_cast<std::uint32_t>(known - scene.lineRecords.begin());
    constexpr std::size_t kMost = 256;  // of shaders/lib/lines.glsl
    if (scene.lineRecords.size() == kMost)
        throw Error(ExitCode::badData, {},
            fmt::format("objects and materials give their lines more than {} different looks", kMost - 1),
            "let more of them share line_color and crease_angle");
    scene.lineRecords.push_back(both);
    return static_cast<std::uint32_t>(scene.lineRecords.size() - 1);
}

FrameRequest frameRequest(const RenderConfig& config, double frame) {
    return {
        config.file.string(), config.camera, frame, config.image.size, config.image.dpi, config.sections, config.scale};
}

/// The sections that are asked for, and their materials.
static std::vector<std::uint32_t> resolveSections(
    const Scene& scene, const FrameRequest& request, DrawScene& draw, std::vector<Material>& materials) {
    std::vector<std::string> names;
    for (const auto& section : scene.sections) names.push_back(section.base.name);
    for (const auto& name : request.sections)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw Error(ExitCode::usage, {request.file},
                fmt::format("there is no section '{}' in {}", name, scene.file),
                names.empty() ? "add a [[section]] with that name to the scene" : nameRemedy(name, names));
    std::vector<std::uint32_t> numbers;
    for (const auto& keyed : scene.sections) {
        if (!keyed.base.name.empty()
            && std::find(request.sections.begin(), request.sections.end(), keyed.base.name) == request.sections.end())
            continue;
        const Section section = keyed.at(request.frame);
        const double length = glm::length(section.normal);
        if (!(length > 0))
            throw Error(ExitCode::usage, {scene.file},
                fmt::format("the normal of section '{}' has no length at frame {}", section.name, request.frame),
                "keep its keys from pointing opposite ways");
        draw.sections.push_back({section.point, section.normal / length});
        numbers.push_back(static_cast<std::uint32_t>(materials.size()));
        const auto pixels = [&](const PictureLength& width) {
            return width.inPixels(request.imageSize.y, request.dpi);
        };
        materials.push_back({.name = "section " + section.name,
            .color = section.fill,
            .isCut = true,
            .hatch = {pixels(section.hatch), pixels(section.hatchWidth), section.hatchAngle, section.hatchColor}});
    }
    return numbers;
}

/// How many triangles a mesh may become, at most. A face of n corners becomes n grids of 2^(level - 1) squares each
/// way; one that meets itself is first cut into n - 2 triangles, of three such grids each. Rates of edges are bounded
/// by the level.
static std::uint64_t mostTriangles(const MeshSource& source, const PolyMesh& poly) {
    return std::uint64_t{poly.cornerPosition.size()}
    << (source.subdivision.present ? 2 * source.subdivision.level + 1 : 0);
}

DrawScene resolveFrame(const LoadedScene& loaded, const FrameRequest& request) {
    const Scene& scene = loaded.scene;
    const std::string& cameraName = request.camera;
    const double frame = request.frame;
    DrawScene draw;
    draw.info.up = scene.upVector();
    draw.info.bounds = loaded.bounds;
    MaterialTable materials(loaded, frame);
    const auto cutMaterials = resolveSections(scene, request, draw, materials.materials);
    std::uint32_t nextObject = 1;
    for (const auto& keyed : scene.instances) {
        const Instance instance = keyed.at(frame);
        const std::size_t mesh = meshIndex(scene, instance.mesh);
        const PolyMesh& poly = loaded.meshes[mesh].poly;
        DrawInstance placed{static_cast<int>(mesh), instance.transform(), {}, nextObject, keyed.base.name,
            poly.partNames, {}, !poly.colors.empty(), mostTriangles(scene.meshes[mesh], poly)};
        for (const auto& name : poly.materialNames)
            placed.materials.push_back(
                instance.material.empty() ? materials.ofMesh(mesh, name) : materials.named(instance.material));
        placed.materials.insert(placed.materials.end(), cutMaterials.begin(), cutMaterials.end());
        for (const auto material : placed.materials)
            placed.lineRecords.push_back(lineRecord(draw, instance, materials.materials[material]));
        nextObject += static_cast<std::uint32_t>(poly.partNames.size())
            + (cutMaterials.empty() ? 0 : 1);  // cut faces are an object of their own
        draw.instances.push_back(std::move(placed));
    }
    draw.materials = std::move(materials.materials);

    if (!cameraName.empty()) {
        std::vector<std::string> names;
        for (const auto& camera : scene.cameras) {
            names.push_back(camera.base.name);
            if (camera.base.name == cameraName) draw.camera = camera.at(frame);
        }
        if (draw.camera.name.empty())
            throw Error(ExitCode::usage, {scene.file}, fmt::format("there is no camera '{}'", cameraName),
                nameRemedy(cameraName, names));
    } else if (!scene.cameras.empty()) {
        draw.camera = scene.cameras.front().at(frame);
    } else {
        draw.camera = framingCamera(draw.info, request.imageSize);
    }
    if (request.scale > 0) {
        if (draw.camera.orthographicHeight <= 0)
            throw Error(ExitCode::usage, {scene.file},
                fmt::format("camera '{}' cannot draw to scale: it sees in perspective", draw.camera.name),
                "give it orthographic_height (any), or leave sheet.scale out");
        const double paperMetres = request.imageSize.y / request.dpi * 0.0254;
        draw.camera.orthographicHeight = paperMetres / request.scale / scene.metersPerUnit;
    }
    if (draw.camera.position == draw.camera.lookAt)
        throw Error(ExitCode::usage, {scene.file},
            fmt::format("camera '{}' looks at the point where it stands", draw.camera.name),
            "move look_at away from position");
    for (const auto& keyed : scene.lights) {
        Light light = keyed.at(frame);
        const double size =
            std::max({std::abs(light.direction.x), std::abs(light.direction.y), std::abs(light.direction.z)});
        if (light.kind != LightKind::point && !(size > 0))
            throw Error(ExitCode::usage, {scene.file},
                fmt::format("the direction of light '{}' has no length at frame {}", light.name, frame),
                "keep its keys from pointing opposite ways");
        if (size > 0) light.direction = glm::normalize(light.direction / size);
        draw.lights.push_back(std::move(light));
    }
    if (draw.lights.empty()) draw.lights.push_back(defaultSun(draw.camera, draw.info));
    return draw;
}

SceneFacts sceneFacts(const DrawScene& scene) {
    SceneFacts facts{scene.info, scene.lights, scene.instances, scene.materials};
    facts.lineRecords = scene.lineRecords.size() > 1;
    facts.sections = !scene.sections.empty();
    facts.hatched = std::any_of(scene.materials.begin(), scene.materials.end(),
        [](const auto& material) { return material.hatch.spacing > 0; });
    for (const auto& instance : scene.instances)
        for (const auto number : instance.materials) {
            const Material& material = scene.materials[number];
            facts.textured = facts.textured || !material.texture.empty();
            facts.cutouts = facts.cutouts || !material.cutout.empty();
            facts.shiny = facts.shiny || (material.shininess > 1 && material.specular > 0);
            facts.vertexColors = facts.vertexColors || (instance.hasColors && material.vertexColors);
        }
    // Steps of four, so that few scenes need shaders of their own.
    std::uint64_t most = 1;
    for (const auto& instance : scene.instances) most = std::max(most, instance.mostTriangles);
    const int bits = 32 - (static_cast<int>(std::bit_width(scene.instances.size())) + 3) / 4 * 4;
    if (!facts.sections && bits > 0 && most <= std::uint64_t{1} << bits) facts.triangleBits = bits;
    for (const auto& light : scene.lights)
        facts.coloredLight = facts.coloredLight || light.color.r != light.color.g || light.color.g != light.color.b;
    return facts;
}

}  // namespace limn
