#include "formats/scene_file.h"

#include "base/file.h"
#include "base/text.h"
#include "scene/frames.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

namespace limn {
namespace {

struct SceneHeader {
    Axis up = Axis::y;
};
constexpr Field kHeader[] = {
    field<&SceneHeader::up>("up", "The axis that points up: \"y\" or \"z\"."),
};

struct Units {
    double metersPerUnit = 1;
};
constexpr Field kUnits[] = {
    field<&Units::metersPerUnit>(
        "meters_per_unit", {.unit = "metres", .min = 1e-12, .max = 1e12}, "Size of one scene unit."),
};

constexpr Field kMesh[] = {
    field<&MeshSource::name>("name", {.required = true}, "Name by which instances call the mesh."),
    field<&MeshSource::file>("file", {.required = true},
        "OBJ file, relative to the scene file; with #### for the number of the frame, a file for each that the scene "
        "declares."),
    field<&MeshSource::parts>("parts",
        "Names of the file's parts (an OBJ's o and g; * and ? stand for any letters) that the mesh consists of; "
        "without "
        "it all. Instances then give some parts their own material, lines and place."),
    field<&MeshSource::withoutParts>("without_parts", "Names of parts that are left out, as `parts`."),
    field<&MeshSource::creases>("creases",
        "Sidecar for files without subdivision tags: a TOML file with creases = [[vertex, vertex, sharpness], ...] and "
        "corners = [[vertex, sharpness], ...]; vertices count from 0, sharpness 10 is infinite."),
};

/// Fields of a place, as an instance or a node has them.
constexpr std::array kPlace{
    field<&Placement::name>("name", "Name of the object; the mesh's name if left out."),
    field<&Placement::parent>("parent", "An instance or node that it moves with; its place then counts from there."),
    field<&Placement::translate>("translate", {.unit = "scene units"}, "Where the origin goes."),
    field<&Placement::rotate>("rotate", {.unit = "degrees"}, "Turn about x, then y, then z."),
    field<&Placement::quaternion>(
        "quaternion", "Turn as [w, x, y, z], instead of rotate: between keys the shortest way."),
    field<&Placement::scale>("scale", "Stretch along the own axes; negative mirrors."),
    field<&Placement::matrix>("matrix", "4×4 matrix in row order, instead of translate, rotate, quaternion and scale."),
};

constexpr std::array kInstanceOwn{
    field<&Instance::mesh>("mesh", {.required = true}, "Name of the mesh to draw."),
    field<&Instance::material>("material", "Material that replaces those of the mesh."),
    field<&Instance::visible>("visible", "false: it is not drawn; may be keyed."),
    field<&Instance::lines>("lines", "false: no lines are drawn of this object."),
    field<&Instance::lineColor>("line_color", "Colour of the lines of this object; \"same\": as elsewhere."),
    field<&Instance::creaseAngle>("crease_angle", {.unit = "degrees", .min = 0, .max = 180},
        "Smallest angle between normals that is drawn on this object; 0: as elsewhere."),
};

constexpr auto kInstance = joinFields(kPlace, kInstanceOwn);

constexpr Field kSequence[] = {
    field<&SequenceSettings::first>("first", {.min = -1e8, .max = 1e8, .required = true}, "Number of the first file."),
    field<&SequenceSettings::last>("last", {.min = -1e8, .max = 1e8, .required = true}, "Number of the last file."),
    field<&SequenceSettings::start>(
        "start", {.unit = "frames", .min = -1e8, .max = 1e8}, "The frame that shows the first file."),
    field<&SequenceSettings::speed>(
        "speed", {.unit = "files per frame", .min = 0, .max = 1000}, "0.5: each file twice."),
    field<&SequenceSettings::ends>("ends", "Before the first file and after the last: hold, loop or bounce."),
};

constexpr Field kCamera[] = {
    field<&Camera::name>("name", "Name by which configs call the camera."),
    field<&Camera::parent>("parent", "An instance or node that position, look_at and up move with."),
    field<&Camera::target>("target", "An instance or node to look at; look_at is then counted from its origin."),
    field<&Camera::orbit>("orbit", {.unit = "degrees"},
        "How far the camera has gone around the point that it looks at; keyed from 0 to 360 it is a turntable."),
    field<&Camera::position>("position", {.unit = "scene units", .required = true}, "Where the camera stands."),
    field<&Camera::lookAt>("look_at", {.unit = "scene units", .required = true},
        "The point in the middle of the picture (without shift)."),
    field<&Camera::up>("up", "Direction that points up in the picture; the scene's up axis if left out."),
    field<&Camera::focalLength>(
        "focal_length", {.unit = "mm", .min = 0.01, .max = 1e5}, "Focal length; 35 if neither it nor fov is given."),
    field<&Camera::sensorWidth>(
        "sensor_width", {.unit = "mm", .min = 0.01, .max = 1e4}, "Width of the sensor behind the lens."),
    field<&Camera::fov>(
        "fov", {.unit = "degrees", .min = 0.001, .max = 179}, "Horizontal field of view, instead of focal_length."),
    field<&Camera::orthographicHeight>("orthographic_height", {.unit = "scene units", .min = 1e-12},
        "Height of the picture in the scene: makes the camera orthographic."),
    field<&Camera::shift>("shift", {.min = -10, .max = 10},
        "Lens shift right and up, in fractions of the longer image side; keeps verticals vertical."),
    field<&Camera::near>(
        "near", {.unit = "scene units", .min = 0}, "Nearest distance drawn; chosen from the scene if left out."),
    field<&Camera::far>("far", {.unit = "scene units", .min = 0},
        "Far distance that paper modes refer to; the scene's far end if left out."),
};

constexpr Field kLight[] = {
    field<&Light::name>("name", "Name of the light."),
    field<&Light::parent>("parent", "An instance or node that direction and position move with."),
    field<&Light::kind>("kind", "sun (parallel), point or spot."),
    field<&Light::direction>("direction", "Direction in which the light travels (sun, spot)."),
    field<&Light::position>("position", {.unit = "scene units"}, "Where the light stands (point, spot)."),
    field<&Light::color>("color", "Colour of the light."),
    field<&Light::intensity>("intensity", {.min = 0, .max = 1e6}, "Strength."),
    field<&Light::range>("range", {.unit = "scene units", .min = 0},
        "Distance at which a point or spot light has fallen to half; 0 = it does not fall."),
    field<&Light::angle>("angle", {.unit = "degrees", .min = 0.1, .max = 179}, "Full opening angle of a spot."),
    field<&Light::blend>("blend", {.min = 0, .max = 1}, "Part of a spot's cone over which it fades out."),
};

constexpr Field kShadow[] = {
    field<&ShadowSettings::resolution>(
        "resolution", {.unit = "texels", .min = 16, .max = 16384, .accuracy = true}, "Side of the shadow map."),
    field<&ShadowSettings::softness>(
        "softness", {.unit = "texels", .min = 0, .max = 16}, "Width of the shadow's edge."),
};

constexpr Field kSubdivision[] = {
    field<&SubdivisionSettings::scheme>("scheme", "catmull-clark, loop (triangles) or bilinear."),
    field<&SubdivisionSettings::level>("level", {.min = 0, .max = 10, .accuracy = true},
        "Times that every edge is halved; with edge_length the most it may be."),
    field<&SubdivisionSettings::limit>(
        "limit", "Draw the limit surface; false: the points of plain refinement, as some programs show."),
    field<&SubdivisionSettings::edgeLength>("edge_length",
        "Cut edges to about this length over the camera's whole path: \"2px\" or scene units such as \"0.1\". Level 8 "
        "then unless level is given."),
    field<&SubdivisionSettings::boundary>("boundary",
        "Rims of open meshes: none (faces at the rim vanish), edge_only (rounded corners), edge_and_corner, or what "
        "the file says."),
    field<&SubdivisionSettings::uvBoundary>("uv_boundary", "Where texture coordinates stay straight."),
    field<&SubdivisionSettings::weld>("weld",
        "Join edges of one part that lie in the same place, as where files are split along seams of texture "
        "coordinates; false: such seams tear open."),
    field<&SubdivisionSettings::creaseMethod>("crease_method", "How semi-sharp creases soften: normal or chaikin."),
};

constexpr Field kMaterial[] = {
    field<&Material::name>("name", {.required = true}, "Name; a material of the same name in an MTL file is replaced."),
    field<&Material::color>("color", "Colour of the object."),
    field<&Material::lines>("lines", "false: no lines are drawn of objects of this material."),
    field<&Material::lineColor>(
        "line_color", "Colour of the lines of objects of this material; \"same\": as elsewhere."),
    field<&Material::creaseAngle>("crease_angle", {.unit = "degrees", .min = 0, .max = 180},
        "Smallest angle between normals that is drawn on objects of this material; 0: as elsewhere."),
    field<&Material::texture>("texture", "Image multiplied onto the colour, relative to the scene file."),
    field<&Material::cutout>("cutout",
        "Image that cuts holes where its alpha (its brightness, if it has none) is below one half; relative to the "
        "scene file."),
    field<&Material::textureScale>("texture_scale", {.min = -kMostRepeats, .max = kMostRepeats},
        "Times that the images are shown across one unit of texture coordinates."),
    field<&Material::textureOffset>("texture_offset", {.min = -kMostRepeats, .max = kMostRepeats},
        "Added to texture coordinates then: 0.5 moves the images by half of themselves."),
    field<&Material::textureRepeats>("texture_repeats", "false: beyond the images their borders go on."),
    field<&Material::textureFilter>("texture_filter",
        "Between texels: linear, nearest (texels are squares), or automatic: nearest where an image has at most 64 "
        "texels a side and cuts no holes."),
    field<&Material::vertexColors>(
        "vertex_colors", "Multiply the mesh's vertex colours, where it has any, onto the colour."),
    field<&Material::shininess>(
        "shininess", {.min = 0, .max = 10000}, "Exponent of the highlight; none at 1 or below."),
    field<&Material::specular>("specular", {.min = 0, .max = 10}, "Strength of the highlight."),
};

constexpr Field kCut[] = {
    field<&CutLook::fill>("fill", "Colour of its cut faces; \"same\": the section's."),
    field<&CutLook::hatch>("hatch", {.unit = "picture", .min = -1},
        "Distance of hatching lines on them; 0 for none, below 0: the section's."),
    field<&CutLook::hatchAngle>("hatch_angle", {.unit = "degrees", .min = -1, .max = 360},
        "Their angle from the picture's horizontal; below 0: the section's."),
    field<&CutLook::hatchColor>("hatch_color", "Their colour; \"same\": the section's."),
};

constexpr Field kSection[] = {
    field<&Section::name>(
        "name", "Name by which configs ask for the cut (sections = [\"NAME\"]); without one it is always made."),
    field<&Section::point>("point", {.unit = "scene units", .required = true}, "Any point on the plane."),
    field<&Section::normal>("normal", {.required = true}, "Direction across the plane, towards what is cut away."),
    field<&Section::fill>("fill", "Colour of the cut faces."),
    field<&Section::hatch>(
        "hatch", {.unit = "picture", .min = 0}, "Distance of hatching lines on the cut faces; 0 for none."),
    field<&Section::hatchAngle>("hatch_angle", {.unit = "degrees"}, "Their angle from the picture's horizontal."),
    field<&Section::hatchWidth>("hatch_width", {.unit = "picture", .min = 0}, "Their width."),
    field<&Section::hatchColor>("hatch_color", "Their colour."),
};

struct Animation {
    std::string frames;
    double fps = 24;
};
constexpr Field kAnimation[] = {
    field<&Animation::frames>("frames", {.required = true}, "Range of frames, such as \"1-240\"."),
    field<&Animation::fps>("fps", {.unit = "frames per second", .min = 0.001, .max = 1e6}, "Playing speed."),
};

class SceneReader {
public:
    SceneReader(const Node& document, const std::filesystem::path& path) : document_(document) {
        scene_.file = path.string();
    }

    Scene read() {
        if (document_.find("scene") && !document_.find("mesh"))
            throw Error(ExitCode::badData, {document_.where.file}, "is a config, not a scene",
                "name the scene that this config draws");
        static constexpr std::string_view sections[] = {
            "version", "units", "mesh", "node", "instance", "camera", "light", "material", "section", "animation"};
        SceneHeader header;
        readVersion(document_, "the scene", errors_);
        readFields(document_, kHeader, &header, nullptr, "the scene", errors_, sections);
        scene_.up = header.up;
        if (const Node* node = document_.find("units")) {
            Units units;
            readFields(*node, kUnits, &units, nullptr, "[units]", errors_);
            scene_.metersPerUnit = units.metersPerUnit;
        }
        readAnimation();
        forEach("mesh", [&](const Node& node) { readMesh(node); });
        forEach("material", [&](const Node& node) { readMaterial(node); });
        forEach("node", [&](const Node& node) { readNode(node); });
        forEach("instance", [&](const Node& node) { readInstance(node); });
        forEach("camera", [&](const Node& node) { readCamera(node); });
        forEach("light", [&](const Node& node) { readLight(node); });
        forEach("section", [&](const Node& node) { readSection(node); });
        checkParents();
        if (scene_.meshes.empty() && errors_.empty())
            fail(document_, "the scene has no [[mesh]]", "add one:  [[mesh]]  name = \"chair\"  file = \"chair.obj\"");
        errors_.throwIfAny();
        if (scene_.instances.empty())
            for (const auto& mesh : scene_.meshes) {
                Keyed<Instance>& instance = scene_.instances.emplace_back();
                instance.base.name = instance.base.mesh = mesh.name;
            }
        return std::move(scene_);
    }

private:
    void fail(const Node& node, std::string problem, std::string remedy, ExitCode code = ExitCode::usage) {
        errors_.add({code, node.where, std::move(problem), std::move(remedy)});
    }

    template <class Read>
    void forEach(std::string_view section, Read read) {
        const Node* list = document_.find(section);
        if (!list) return;
        if (!list->isArray())
            return fail(*list, fmt::format("'{}' must be a list of tables", section),
                fmt::format("write [[{}]] with two brackets", section));
        for (const auto& node : list->array()) read(node);
    }

    template <class T>
    Keyed<T> readTable(
        const Node& node, Schema schema, std::string_view what, std::span<const std::string_view> alsoKnown = {}) {
        Keyed<T> keyed;
        readFields(node, schema, &keyed.base, &keyed.tracks, what, errors_, alsoKnown);
        return keyed;
    }

    std::string resolveFile(const Node& node, std::string_view key, const std::string& file) {
        if (file.empty()) return file;
        const auto path = pathIn(*node.find(key));
        if (!fileExists(path))
            fail(*node.find(key), fmt::format("'{}' does not exist", path.string()),
                "paths are relative to the file that names them", ExitCode::missingInput);
        return path.string();
    }

    /// A file per frame: all that the scene declares must be there.
    std::string resolveFrames(const Node& node, const SequenceSettings& sequence) {
        const auto path = pathIn(node);
        const MeshSource source{.file = path.string(), .perFrame = true, .sequence = sequence};
        const FrameRange frames = scene_.frames.value_or(FrameRange{});
        std::string first;
        int missing = 0;
        std::set<int> known;
        for (std::int64_t frame = frames.first; frame <= frames.last; ++frame) {
            if (!known.insert(source.numberAt(static_cast<int>(frame))).second) continue;
            if (const auto file = source.at(static_cast<int>(frame)); !fileExists(file) && missing++ == 0)
                first = file.string();
        }
        if (missing > 0)
            fail(node,
                fmt::format("'{}' does not exist{}", first,
                    missing > 1 ? fmt::format(", nor do {} more of its frames", missing - 1) : ""),
                "#### stands for the number of each frame that the scene declares; paths are relative to the file that "
                "names them",
                ExitCode::missingInput);
        return path.string();
    }

    void readAnimation() {
        const Node* node = document_.find("animation");
        if (!node) return;
        Animation animation;
        readFields(*node, kAnimation, &animation, nullptr, "[animation]", errors_);
        scene_.fps = animation.fps;
        scene_.frames = parseFrameRange(animation.frames);
        if (!animation.frames.empty() && !scene_.frames)
            fail(*node->find("frames"), fmt::format("frames '{}' is no range", animation.frames),
                fmt::format("write for example frames = \"1-240\", with at most {} frames", kMostFrames));
    }

    void readSequence(const Node& node, SequenceSettings& settings) {
        settings.present = true;
        readFields(node, kSequence, &settings, nullptr, "sequence", errors_);
        if (settings.last < settings.first || settings.last - std::int64_t{settings.first} >= kMostFrames)
            fail(node, fmt::format("the files {} to {} are no range", settings.first, settings.last),
                fmt::format("give last at least the number of first, and at most {} files", kMostFrames));
    }

    void readMesh(const Node& node) {
        static constexpr std::string_view alsoKnown[] = {"subdivision", "sequence"};
        auto mesh = readTable<MeshSource>(node, kMesh, "[[mesh]]", alsoKnown).base;
        if (const Node* settings = node.find("subdivision")) readSubdivision(*settings, mesh.subdivision);
        mesh.creases = resolveFile(node, "creases", mesh.creases);
        mesh.where = node.where;
        // A file may simply have such a name.
        mesh.perFrame =
            hasFrameNumber(std::filesystem::path(mesh.file).filename()) && !fileExists(pathIn(*node.find("file")));
        if (const Node* sequence = node.find("sequence")) {
            readSequence(*sequence, mesh.sequence);
            if (!mesh.perFrame && errors_.empty())
                fail(*sequence, "the mesh has one file for all frames", "put #### where file has the frame's number");
            if (!errors_.empty()) return;
        }
        mesh.file =
            mesh.perFrame ? resolveFrames(*node.find("file"), mesh.sequence) : resolveFile(node, "file", mesh.file);
        if (!meshNames_.insert(mesh.name).second)
            fail(node, fmt::format("there are two meshes named '{}'", mesh.name), "give each its own name");
        scene_.meshes.push_back(std::move(mesh));
    }

    void readSubdivision(const Node& node, SubdivisionSettings& settings) {
        settings.present = true;
        readFields(node, kSubdivision, &settings, nullptr, "subdivision", errors_);
        if (settings.edgeLength.empty()) return;
        if (!node.find("level")) settings.level = 8;
        if (!settings.wantedEdge())
            fail(*node.find("edge_length"), fmt::format("edge_length '{}' is no length", settings.edgeLength),
                "write \"2px\", or scene units such as \"0.1\"");
    }

    void readMaterial(const Node& node) {
        static constexpr std::string_view alsoKnown[] = {"cut"};
        auto material = readTable<Material>(node, kMaterial, "[[material]]", alsoKnown);
        if (const Node* cut = node.find("cut")) readFields(*cut, kCut, &material.base.cut, nullptr, "cut", errors_);
        material.base.texture = resolveFile(node, "texture", material.base.texture);
        material.base.cutout = resolveFile(node, "cutout", material.base.cutout);
        if (!materialNames_.insert(material.base.name).second)
            fail(node, fmt::format("there are two materials named '{}'", material.base.name), "give each its own name");
        scene_.materials.push_back(std::move(material));
    }

    void requireName(
        const Node& node, std::string_view key, const std::string& name, const std::set<std::string>& names) {
        const Node* given = node.find(key);
        if (!given || names.contains(name)) return;
        const std::vector<std::string> candidates(names.begin(), names.end());
        fail(*given, fmt::format("there is no {} named '{}'", key, name),
            candidates.empty() ? fmt::format("add a [[{}]] with that name", key) : nameRemedy(name, candidates));
    }

    void checkPlace(const Node& node, const Placement& place) {
        if (const Node* matrix = node.find("matrix")) {
            const auto& m = place.matrix;
            if (m.size() != 16)
                fail(*matrix, fmt::format("'matrix' has {} numbers", m.size()), "give 16, in row order");
            else if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
                fail(*matrix, "the last row of 'matrix' is not 0 0 0 1",
                    "rows come one after the other; translation stands at the end of the first three");
            for (const auto other : {"translate", "rotate", "quaternion", "scale"})
                if (node.find(other))
                    fail(*node.find(other), fmt::format("'{}' stands beside 'matrix'", other), "use one or the other");
        }
        if (node.find("quaternion") && node.find("rotate"))
            fail(*node.find("quaternion"), "'quaternion' stands beside 'rotate'", "use one or the other");
    }

    void noteParent(const Node& node, const std::string& key, const std::string& own, const std::string& parent) {
        if (const Node* given = node.find(key)) parents_.push_back({given->where, key, own, parent});
    }

    void readNode(const Node& node) {
        auto place = readTable<Placement>(node, kPlace, "[[node]]");
        checkPlace(node, place.base);
        if (place.base.name.empty()) fail(node, "the node has no name", "name it: others call it by that");
        noteParent(node, "parent", place.base.name, place.base.parent);
        scene_.nodes.push_back(std::move(place));
    }

    void readInstance(const Node& node) {
        auto instance = readTable<Instance>(node, kInstance, "[[instance]]");
        requireName(node, "mesh", instance.base.mesh, meshNames_);
        requireName(node, "material", instance.base.material, materialNames_);
        checkPlace(node, instance.base);
        if (instance.base.name.empty()) instance.base.name = instance.base.mesh;
        noteParent(node, "parent", instance.base.name, instance.base.parent);
        scene_.instances.push_back(std::move(instance));
    }

    /// Every parent is there once, and nothing is its own ancestor.
    void checkParents() {
        if (parents_.empty()) return;
        std::map<std::string, int> count;
        std::map<std::string, std::string> parentOf;
        const auto know = [&](const Placement& place) {
            ++count[place.name];
            parentOf[place.name] = place.parent;
        };
        for (const auto& node : scene_.nodes) know(node.base);
        for (const auto& instance : scene_.instances) know(instance.base);
        std::vector<std::string> names;
        names.reserve(count.size());
        for (const auto& [name, times] : count) names.push_back(name);
        for (const auto& wanted : parents_) {
            const auto add = [&](std::string problem, std::string remedy) {
                errors_.add({ExitCode::usage, wanted.where, std::move(problem), std::move(remedy)});
            };
            if (!count.contains(wanted.parent))
                add(fmt::format("there is no instance or node named '{}'", wanted.parent),
                    nameRemedy(wanted.parent, names));
            else if (count[wanted.parent] > 1)
                add(fmt::format("there are several instances or nodes named '{}'", wanted.parent),
                    "give each its own name");
            else if (isOwnAncestor(wanted, parentOf))
                add(fmt::format("'{}' is its own ancestor", wanted.own), "break the circle of parents");
        }
    }

    /// A name that must be an instance's or a node's: where it stands, its key, and who says it.
    struct ParentName {
        Location where;
        std::string key, own, parent;
    };

    static bool isOwnAncestor(const ParentName& wanted, const std::map<std::string, std::string>& parentOf) {
        std::set<std::string> seen{wanted.own};
        if (wanted.own.empty()) return false;
        for (std::string at = wanted.parent; !at.empty();) {
            if (!seen.insert(at).second) return true;
            const auto next = parentOf.find(at);
            at = next == parentOf.end() ? "" : next->second;
        }
        return false;
    }

    void readCamera(const Node& node) {
        auto camera = readTable<Camera>(node, kCamera, "[[camera]]");
        if (camera.base.name.empty()) camera.base.name = fmt::format("camera{}", scene_.cameras.size() + 1);
        int lenses = 0;
        for (const auto key : {"focal_length", "fov", "orthographic_height"}) lenses += node.find(key) != nullptr;
        if (camera.base.far > 0 && camera.base.near >= camera.base.far)
            fail(node, "the camera's near distance is not below its far distance", "lower near or raise far");
        if (lenses > 1)
            fail(node, "a camera can have only one of focal_length, fov and orthographic_height", "remove the others");
        if (node.find("position") && node.find("look_at") && !camera.moves() && camera.base.target.empty()
            && camera.base.position == camera.base.lookAt)
            fail(*node.find("look_at"), "the camera looks at the point where it stands",
                "move look_at away from position");
        noteParent(node, "parent", "", camera.base.parent);
        noteParent(node, "target", "", camera.base.target);
        scene_.cameras.push_back(std::move(camera));
    }

    void readLight(const Node& node) {
        static constexpr std::string_view alsoKnown[] = {"shadow"};
        auto light = readTable<Light>(node, kLight, "[[light]]", alsoKnown);
        if (const Node* shadow = node.find("shadow")) {
            light.base.shadow.present = true;
            readFields(*shadow, kShadow, &light.base.shadow, nullptr, "shadow", errors_);
        }
        if (light.base.kind != LightKind::point && glm::length(light.base.direction) == 0)
            fail(node, "the light's direction has no length", "give a direction such as [-1, -2, -1]");
        noteParent(node, "parent", "", light.base.parent);
        scene_.lights.push_back(std::move(light));
    }

    void readSection(const Node& node) {
        auto section = readTable<Section>(node, kSection, "[[section]]");
        if (node.find("normal") && glm::length(section.base.normal) == 0)
            fail(*node.find("normal"), "the section's normal has no length", "give a direction such as [0, 0, 1]");
        for (const auto& other : scene_.sections)
            if (!section.base.name.empty() && other.base.name == section.base.name)
                fail(node, fmt::format("there are two sections named '{}'", section.base.name),
                    "give each its own name");
        scene_.sections.push_back(std::move(section));
    }

    const Node& document_;
    Scene scene_;
    ErrorCollector errors_;
    std::set<std::string> meshNames_, materialNames_;
    std::vector<ParentName> parents_;
};

}  // namespace

std::vector<SettingsTable> sceneTables() {
    return {{"", "top of the file", kHeader, defaultsOf<SceneHeader>()},
        {"[units]", "what the numbers mean", kUnits, defaultsOf<Units>()},
        {"[[mesh]]", "a mesh file", kMesh, defaultsOf<MeshSource>()},
        {"[[mesh]] subdivision", "draws the subdivision surface of the mesh; without it, its polygons as they are",
            kSubdivision, defaultsOf<SubdivisionSettings>()},
        {"[[mesh]] sequence", "which of a mesh's numbered files each frame shows; without it the one of its own number",
            kSequence, defaultsOf<SequenceSettings>()},
        {"[[node]]", "a place without a mesh, for others to move with", kPlace, defaultsOf<Placement>()},
        {"[[instance]]", "a mesh placed in the scene; without any, each mesh is drawn once where it was modelled",
            kInstance, defaultsOf<Instance>()},
        {"[[camera]]", "a camera; without any, one that frames the scene", kCamera, defaultsOf<Camera>()},
        {"[[light]]", "a light; without any, a sun over the camera's left shoulder", kLight, defaultsOf<Light>()},
        {"[[light]] shadow", "shadow map of a light; without it the light casts none and costs none", kShadow,
            defaultsOf<decltype(Light::shadow)>()},
        {"[[material]]", "a material; without one, the mesh file's own or warm paper grey", kMaterial,
            defaultsOf<Material>()},
        {"[[material]] cut", "the cut faces of a material, where a section goes through it", kCut,
            defaultsOf<CutLook>()},
        {"[[section]]", "a plane that cuts the scene open", kSection, defaultsOf<Section>()},
        {"[animation]", "declared frames; without them the scene is a still", kAnimation, defaultsOf<Animation>()}};
}

Scene parseScene(const Node& document, const std::filesystem::path& path) { return SceneReader(document, path).read(); }

Scene readScene(const std::filesystem::path& path, std::vector<std::filesystem::path>* files) {
    return parseScene(readDocument(path, files), path);
}

static SceneFile readToml(const std::filesystem::path& path) {
    SceneFile file;
    file.scene = readScene(path, &file.files);
    return file;
}

const SceneFormat kSceneToml{".toml", "limn's own scenes: meshes placed, lit and seen by cameras", readToml};

}  // namespace limn
