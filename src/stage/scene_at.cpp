#include "stage/scene_at.h"

#include "base/text.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace limn {
namespace {

/// Gives every material that an instance may show a number; 0 is the default.
class MaterialTable {
public:
    MaterialTable(const Scene& scene, const std::vector<SharedMesh>& meshes, double frame) : meshes_(meshes) {
        materials.push_back({.name = ""});
        for (const auto& material : scene.materials) byName_[material.base.name] = add(material.at(frame));
    }

    std::uint32_t named(const std::string& name) const { return byName_.at(name); }

    /// The number of a mesh's own material: the scene's of that name, else the MTL's, else the default.
    std::uint32_t ofMesh(std::size_t mesh, const std::string& name) {
        if (const auto it = byName_.find(name); it != byName_.end()) return it->second;
        const auto [it, isNew] = byMesh_.emplace(std::pair(mesh, name), 0);
        if (isNew)
            for (const auto& material : meshes_[mesh]->materials)
                if (material.name == name) it->second = add(material);
        // Without a material, vertex colours are the only colour.
        if (isNew && it->second == 0 && !meshes_[mesh]->poly.colors.empty())
            it->second = add({.name = name, .color = {1, 1, 1}});
        return it->second;
    }

    std::vector<Material> materials;

private:
    std::uint32_t add(Material material) {
        materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(materials.size() - 1);
    }

    const std::vector<SharedMesh>& meshes_;
    std::map<std::string, std::uint32_t> byName_;
    std::map<std::pair<std::size_t, std::string>, std::uint32_t> byMesh_;
};

/// The number of an object's and its material's line record; the object overrides the material.
std::uint32_t lineRecord(SceneAt& scene, const Instance& object, const Material& material) {
    const LineRecord both{object.lines && material.lines,
        object.lineColor.given ? object.lineColor : material.lineColor,
        object.creaseAngle > 0 ? object.creaseAngle : material.creaseAngle, material.isCut};
    const auto known = std::find(scene.lineRecords.begin(), scene.lineRecords.end(), both);
    if (known != scene.lineRecords.end()) return static_cast<std::uint32_t>(known - scene.lineRecords.begin());
    if (scene.lineRecords.size() == kMostLineRecords)
        throw Error(ExitCode::badData, {},
            fmt::format("objects and materials give their lines more than {} different looks", kMostLineRecords - 1),
            "let more of them share line_color and crease_angle");
    scene.lineRecords.push_back(both);
    return static_cast<std::uint32_t>(scene.lineRecords.size() - 1);
}

/// The requested sections.
std::vector<Section> resolveSections(const Scene& scene, const FrameRequest& request) {
    std::vector<std::string> names;
    for (const auto& section : scene.sections) names.push_back(section.base.name);
    for (const auto& name : request.sections)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw Error(ExitCode::usage, {request.file},
                fmt::format("there is no section '{}' in {}", name, scene.file),
                names.empty() ? "add a [[section]] with that name to the scene" : nameRemedy(name, names));
    std::vector<Section> sections;
    for (const auto& keyed : scene.sections) {
        if (!keyed.base.name.empty()
            && std::find(request.sections.begin(), request.sections.end(), keyed.base.name) == request.sections.end())
            continue;
        sections.push_back(keyed.at(request.frame));
        const double length = glm::length(sections.back().normal);
        if (!(length > 0))
            throw Error(ExitCode::usage, {scene.file},
                fmt::format("the normal of section '{}' has no length at frame {}", keyed.base.name, request.frame),
                "keep its keys from pointing opposite ways");
        sections.back().normal /= length;
    }
    return sections;
}

/// The materials of cut faces: one for each section and material that it may cut, as lines part unlike ones.
class CutMaterials {
public:
    CutMaterials(std::vector<Section> sections, const FrameRequest& request)
        : sections_(std::move(sections)), request_(request) {}

    const std::vector<Section>& sections() const { return sections_; }

    std::uint32_t of(std::size_t section, std::uint32_t material, std::vector<Material>& materials) {
        const auto [it, isNew] = known_.emplace(std::pair(section, material), 0);
        if (isNew) {
            it->second = static_cast<std::uint32_t>(materials.size());
            materials.push_back(make(sections_[section], materials[material]));
        }
        return it->second;
    }

private:
    Material make(const Section& section, const Material& cut) const {
        const auto pixels = [&](const PictureLength& width) {
            return width.inPixels(request_.imageSize.y, request_.dpi);
        };
        const CutLook& own = cut.cut;
        return {.name = fmt::format("section {}: {}", section.name, cut.name),
            .color = own.fill.otherwise(section.fill),
            .isCut = true,
            .hatch = {pixels(own.hatch.amount >= 0 ? own.hatch : section.hatch), pixels(section.hatchWidth),
                own.hatchAngle >= 0 ? own.hatchAngle : section.hatchAngle,
                own.hatchColor.otherwise(section.hatchColor)}};
    }

    std::vector<Section> sections_;
    const FrameRequest& request_;
    std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> known_;
};

/// The most triangles that a mesh may become. A face of n corners becomes n grids of 2^(level - 1) squares each way;
/// one that meets itself is first cut into n - 2 triangles, of three such grids each. Rates of edges are bounded by the
/// level.
std::uint64_t mostTriangles(const MeshSource& source, const PolyMesh& poly) {
    return std::uint64_t{poly.cornerPosition.size()}
    << (source.subdivision.present ? 2 * source.subdivision.level + 1 : 0);
}

/// The instances, with the numbers of their objects, materials and line records.
void placeInstances(const Scene& scene, CutMaterials& cuts, MaterialTable& materials, SceneAt& at) {
    std::uint32_t nextObject = 1;
    for (const auto& keyed : scene.instances) {
        const Instance instance = keyed.at(at.frame);
        const std::size_t mesh = meshIndex(scene, instance.mesh);
        const PolyMesh& poly = at.meshes[mesh]->poly;
        const std::uint32_t firstObject = nextObject;  // numbers stay the same when others are hidden
        nextObject += static_cast<std::uint32_t>(poly.partNames.size())
            + (cuts.sections().empty() ? 0 : 1);  // cut faces are an object of their own
        if (!instance.visible) continue;
        DrawInstance placed{static_cast<int>(mesh), scene.worldFrom(instance, at.frame), {}, firstObject,
            keyed.base.name, poly.partNames, {}, !poly.colors.empty(), !poly.lines.empty(),
            scene.meshes[mesh].subdivision.present, mostTriangles(scene.meshes[mesh], poly),
            static_cast<std::size_t>(&keyed - scene.instances.data())};
        for (const auto& name : poly.materialNames)
            placed.materials.push_back(
                instance.material.empty() ? materials.ofMesh(mesh, name) : materials.named(instance.material));
        for (std::size_t section = 0; section < cuts.sections().size(); ++section)
            for (std::size_t i = 0; i < poly.materialNames.size(); ++i)
                placed.materials.push_back(cuts.of(section, placed.materials[i], materials.materials));
        for (const auto material : placed.materials)
            placed.lineRecords.push_back(lineRecord(at, instance, materials.materials[material]));
        at.instances.push_back(std::move(placed));
    }
}

Light lightAt(const Scene& scene, const Keyed<Light>& keyed, double frame) {
    Light light = keyed.at(frame);
    if (!light.parent.empty()) {
        const glm::dmat4 world = scene.worldFrom(light.parent, frame);
        light.position = glm::dvec3(world * glm::dvec4(light.position, 1));
        light.direction = glm::dmat3(world) * light.direction;
    }
    const double size =
        std::max({std::abs(light.direction.x), std::abs(light.direction.y), std::abs(light.direction.z)});
    if (light.kind != LightKind::point && !(size > 0))
        throw Error(ExitCode::usage, {scene.file},
            fmt::format("the direction of light '{}' has no length at frame {}", light.name, frame),
            "keep its keys from pointing opposite ways");
    if (size > 0) light.direction = glm::normalize(light.direction / size);
    return light;
}

/// How far the instances reach at the first declared frame, so that the camera stands still over all frames.
double reachOf(const LoadedScene& loaded, const glm::dvec3& direction) {
    const int first = loaded.scene.firstFrame();
    const glm::dvec3 centre = loaded.bounds.centre();
    const bool moves = std::any_of(
        loaded.scene.meshes.begin(), loaded.scene.meshes.end(), [](const MeshSource& mesh) { return mesh.perFrame; });
    if (moves) {  // the files of that frame may be gone from memory
        const glm::dvec3 half = (loaded.bounds.hi - loaded.bounds.lo) / 2.0;
        return glm::dot(glm::abs(direction), half);
    }
    const auto meshes = loaded.meshes->at(first);
    double reach = -std::numeric_limits<double>::infinity();
    for (const auto& keyed : loaded.scene.instances) {
        const Instance instance = keyed.at(first);
        if (!instance.visible) continue;
        const PolyMesh& poly = meshes[meshIndex(loaded.scene, instance.mesh)]->poly;
        const glm::dmat4 world = loaded.scene.worldFrom(instance, first);
        const glm::dvec3 inMesh = glm::transpose(glm::dmat3(world)) * direction;
        const double offset = glm::dot(glm::dvec3(world[3]) - centre, direction);
        const double most = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, poly.cornerPosition.size(), 1 << 16),
            -std::numeric_limits<double>::infinity(),
            [&](const auto& range, double found) {
                for (std::size_t c = range.begin(); c != range.end(); ++c)
                    found = std::max(found, glm::dot(poly.positions[poly.cornerPosition[c]], inMesh));
                return found;
            },
            [](double a, double b) { return std::max(a, b); });
        reach = std::max(reach, most + offset);
        for (const auto& line : poly.lines)
            reach = std::max({reach, glm::dot(line.a, inMesh) + offset, glm::dot(line.b, inMesh) + offset});
    }
    return reach;
}

/// A camera at a frame, moved along with what it belongs to.
Camera placeCamera(const Scene& scene, const Keyed<Camera>& keyed, double frame) {
    Camera camera = keyed.at(frame);
    if (!camera.parent.empty()) {
        const glm::dmat4 world = scene.worldFrom(camera.parent, frame);
        camera.position = glm::dvec3(world * glm::dvec4(camera.position, 1));
        camera.lookAt = glm::dvec3(world * glm::dvec4(camera.lookAt, 1));
        camera.up = glm::dmat3(world) * camera.up;
    }
    if (!camera.target.empty()) camera.lookAt += glm::dvec3(scene.worldFrom(camera.target, frame)[3]);
    if (camera.orbit != 0) {
        const bool hasUp = camera.up != glm::dvec3(0);
        const glm::dvec3 axis = glm::normalize(hasUp ? camera.up : scene.upVector());
        const glm::dquat turn = glm::angleAxis(glm::radians(std::fmod(camera.orbit, 360.0)), axis);
        camera.position = camera.lookAt + turn * (camera.position - camera.lookAt);
    }
    return camera;
}

/// The camera that a request names, before its sheet's scale.
Camera chooseCamera(const LoadedScene& loaded, const FrameRequest& request) {
    const auto& cameras = loaded.scene.cameras;
    if (request.camera.empty())
        return cameras.empty() ? framingCamera(sceneInfo(loaded), request.imageSize,
                   [&](const glm::dvec3& direction) { return reachOf(loaded, direction); })
                               : placeCamera(loaded.scene, cameras.front(), request.frame);
    std::vector<std::string> names;
    names.reserve(cameras.size());
    for (const auto& camera : cameras) names.push_back(camera.base.name);
    const auto named = std::find(names.begin(), names.end(), request.camera);
    if (named == names.end())
        throw Error(ExitCode::usage, {loaded.scene.file}, fmt::format("there is no camera '{}'", request.camera),
            nameRemedy(request.camera, names));
    return placeCamera(loaded.scene, cameras[static_cast<std::size_t>(named - names.begin())], request.frame);
}

}  // namespace

SceneInfo sceneInfo(const LoadedScene& loaded) { return {loaded.bounds, loaded.scene.upVector()}; }

Camera cameraAt(const LoadedScene& loaded, const FrameRequest& request) {
    Camera camera = chooseCamera(loaded, request);
    if (request.scale > 0) {
        if (camera.orthographicHeight <= 0)
            throw Error(ExitCode::usage, {loaded.scene.file},
                fmt::format("camera '{}' cannot draw to scale: it sees in perspective", camera.name),
                "give it orthographic_height (any), or leave sheet.scale out");
        const double paperMetres = request.imageSize.y / request.dpi * 0.0254;
        camera.orthographicHeight = paperMetres / request.scale / loaded.scene.metersPerUnit;
    }
    if (camera.position == camera.lookAt)
        throw Error(ExitCode::usage, {loaded.scene.file},
            fmt::format("camera '{}' looks at the point where it stands", camera.name),
            "move look_at away from position");
    return camera;
}

SceneAt sceneAt(const LoadedScene& loaded, const FrameRequest& request) {
    const Scene& scene = loaded.scene;
    SceneAt at;
    at.frame = request.frame;
    // Moments between frames have the files of those, and none beyond the first and the last.
    int file = static_cast<int>(std::lround(request.frame));
    if (scene.frames && request.frame != file) file = std::clamp(file, scene.frames->first, scene.frames->last);
    at.meshes = loaded.meshes->at(file);
    at.info = sceneInfo(loaded);
    MaterialTable materials(scene, at.meshes, request.frame);
    CutMaterials cuts(resolveSections(scene, request), request);
    for (const auto& section : cuts.sections()) at.sections.push_back({section.point, section.normal});
    placeInstances(scene, cuts, materials, at);
    at.materials = std::move(materials.materials);
    at.camera = cameraAt(loaded, request);
    for (const auto& light : scene.lights) at.lights.push_back(lightAt(scene, light, request.frame));
    if (at.lights.empty()) at.lights.push_back(defaultSun(at.camera, at.info));

    ImageKeys images = loaded.meshes->imageKeys();
    images.insert(loaded.images.begin(), loaded.images.end());
    for (const auto& material : at.materials) {
        at.materialKeys.push_back(materialKey(material, images));
        at.textureKeys.push_back(textureKey(material, images));
    }
    for (const auto& light : at.lights) at.lightKeys.push_back(lightKey(light));
    KeyBuilder key;
    key.add(loaded.key.low).add(loaded.key.high);
    for (const auto& mesh : at.meshes)
        if (mesh) key.add(mesh->key.low).add(mesh->key.high);
    for (const auto& keys : {at.materialKeys, at.lightKeys})
        for (const auto& one : keys) key.add(one.low).add(one.high);
    at.key = key.key();
    return at;
}

}  // namespace limn
