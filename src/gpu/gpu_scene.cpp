#include "gpu/gpu_scene.h"

#include "base/error.h"
#include "base/in_order.h"
#include "gpu/lights.h"
#include "settings/color.h"
#include "stage/shadow_layout.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace limn {
namespace {

// Texture units of the buffers in shaders/scene/scene.glsl and of the atlas in shaders/lib/texture.glsl.
enum Unit {
    positionsUnit = 6,
    trianglesUnit,
    normalsUnit,
    triangleNormalsUnit,
    uvsUnit,
    triangleUvsUnit,
    wordsUnit,
    instancesUnit,
    materialsUnit,
    atlasUnit,
    previousUnit,
    shadowPlacesUnit
};
constexpr int kLightsBinding = 2;

// One instance, as shaders/scene/scene.glsl fetches it: twelve texels of sixteen bytes.
struct GpuInstance {
    double meshFromView[3][4];
    float viewFromMesh[3][4];
    std::uint32_t firstVertex, firstTriangle, materialTable, firstObject;
    std::uint32_t materialWords, partWords, firstNormal, firstUv;
    std::uint32_t triangleCount, colorWords, padding[2];
};
static_assert(sizeof(GpuInstance) == 12 * 16);

// Six texels.
struct GpuMaterial {
    float color[3], levels;
    float shininess, specular, layer, flags;
    float place[4];
    float hatchX, hatchY, hatchWidth, padding2;
    float hatchColor[4];
    float textureScale[2], textureOffset[2];
};
static_assert(sizeof(GpuMaterial) == 6 * 16);

// Of GpuMaterial::flags.
constexpr int kHasHoles = 1, kTakesVertexColors = 2, kIsSharp = 4, kRepeats = 8;

constexpr std::uint32_t kNoWords = ~0u;

// Scenes with fewer triangles are always drawn whole: even software renderers take only milliseconds.
constexpr std::size_t kManyTriangles = 1 << 16;

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// Vertex colours as shaders/scene/scene.glsl reads them: ten display-encoded bits per channel, one colour per triangle
/// corner, or per vertex where vertices are unified.
std::vector<std::uint32_t> packColors(const TriMesh& mesh) {
    std::vector<std::uint32_t> packed(mesh.colors.size()), corners;
    tbb::parallel_for(std::size_t{0}, packed.size(), [&](std::size_t i) {
        for (int k = 0; k < 3; ++k)
            packed[i] |=
                static_cast<std::uint32_t>(std::lround(linearToSrgb(std::clamp(mesh.colors[i][k], 0.0f, 1.0f)) * 1023))
                << (10 * k);
    });
    if (mesh.colorIndices.empty()) return packed;
    corners.reserve(mesh.colorIndices.size());
    for (const auto i : mesh.colorIndices) corners.push_back(packed[i]);
    return corners;
}

/// A scale of 0 flattens a mesh. That is allowed, but leaves no inverse transform: take a billionth of the size
/// instead.
glm::dmat3 invertible(glm::dmat3 m) {
    const double size = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
    if (size == 0) return glm::dmat3(std::numeric_limits<float>::min());
    for (int c = 0; c < 3; ++c) {
        if (glm::length(m[c]) > 1e-9 * size) continue;
        glm::dvec3 across = glm::cross(m[(c + 1) % 3], m[(c + 2) % 3]);
        if (glm::length(across) == 0)
            across = glm::length(m[(c + 1) % 3]) > 0 ? glm::dvec3(-m[(c + 1) % 3].y, m[(c + 1) % 3].x, 1e-3 * size)
                                                     : glm::dvec3(0, 0, 1);
        m[c] = glm::normalize(across) * (1e-9 * size);
    }
    return m;
}

/// The place of an instance's mesh: from mesh units around its pivot to normalized view space.
struct Placement {
    glm::dmat3 linear;
    glm::dvec3 pivot;
};

Placement placementOf(const DrawInstance& instance, const glm::dvec3& pivot, const View& view) {
    return {invertible(view.viewFromRelative * glm::dmat3(instance.worldFromMesh)),
        view.toView(glm::dvec3(instance.worldFromMesh * glm::dvec4(pivot, 1)))};
}

/// Three attribute numbers per triangle, or zeros where a mesh has none: they lie parallel to its triangles.
std::vector<std::uint32_t> besideTriangles(const std::vector<std::uint32_t>& indices, const TriMesh& mesh) {
    return indices.size() == mesh.indices.size() ? indices : std::vector<std::uint32_t>(mesh.indices.size());
}

GpuMaterial packMaterial(const Material& m, const AtlasPlace& place) {
    const auto number = [](int value) { return static_cast<float>(value); };
    const int flags = (m.cutout.empty() ? 0 : kHasHoles) | (m.vertexColors ? kTakesVertexColors : 0)
        | (hasSharpTexels(m, place.size) ? kIsSharp : 0) | (m.textureRepeats ? kRepeats : 0);
    const glm::vec2 scale(m.textureScale), offset(m.textureOffset);
    GpuMaterial gpu{{m.color.r, m.color.g, m.color.b}, number(place.levels), m.shininess, m.specular,
        number(place.corner.z), number(flags),
        {number(place.corner.x), number(place.corner.y), number(place.size.x), number(place.size.y)}, 0, 0,
        static_cast<float>(m.hatch.width), 0, {m.hatch.color.r, m.hatch.color.g, m.hatch.color.b, 0},
        {scale.x, scale.y}, {offset.x, offset.y}};
    if (m.hatch.spacing > 0) {  // across the lines, one per distance between them
        gpu.hatchX = static_cast<float>(-std::sin(glm::radians(m.hatch.angle)) / m.hatch.spacing);
        gpu.hatchY = static_cast<float>(std::cos(glm::radians(m.hatch.angle)) / m.hatch.spacing);
    }
    return gpu;
}

/// Writes a small buffer if its data changed, and replaces it if its size changed. Returns whether it was replaced.
bool putChanged(gl::Buffer& buffer, std::vector<std::byte>& known, std::span<const std::byte> data, const char* label) {
    if (buffer && std::equal(known.begin(), known.end(), data.begin(), data.end())) return false;
    const bool isNew = !buffer || buffer.size() != data.size();
    if (isNew)
        buffer = gl::Buffer(data, label);
    else
        buffer.write(data);
    known.assign(data.begin(), data.end());
    return isNew;
}

/// Removes these triangles (ascending) from a list of corners. The last corner is a triangle's number.
void leaveOut(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& corners) {
    if (triangles.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        if (std::binary_search(triangles.begin(), triangles.end(), corners[i + 2])) continue;
        std::copy_n(
            corners.begin() + static_cast<std::ptrdiff_t>(i), 3, corners.begin() + static_cast<std::ptrdiff_t>(kept));
        kept += 3;
    }
    corners.resize(kept);
}

}  // namespace

GpuScene::GpuScene(const gl::Limits& limits, bool isSoftware) : limits_(limits), isSoftware_(isSoftware) {}

std::set<ContentKey> GpuScene::residents() const {
    std::set<ContentKey> keys;
    for (const auto& [key, resident] : residents_) keys.insert(key);
    return keys;
}

void GpuScene::require(SceneData needs, std::size_t lineRecords) {
    const std::size_t recordWords = lineRecords * lineRecordWords({}).size();
    if (isReady_ && needs == needs_ && recordWords <= records_.count) return;
    needs_ = needs;
    const auto most = static_cast<std::uint64_t>(limits_.maxBufferTexels);
    residents_.clear();
    shown_.clear();
    positions_ = Arena("vertices", sizeof(glm::vec3), most, isSoftware_);
    triangles_ = Arena("triangles", 3 * sizeof(std::uint32_t), most, isSoftware_);
    normals_ = Arena("normals", sizeof(glm::vec3), most);
    triangleNormals_ = Arena("triangles' normals", 3 * sizeof(std::uint32_t), most);
    uvs_ = Arena("uvs", sizeof(glm::vec2), most);
    triangleUvs_ = Arena("triangles' uvs", 3 * sizeof(std::uint32_t), most);
    words_ = Arena("materials, parts and vertex colours", sizeof(std::uint32_t), most);
    records_ = {0, static_cast<std::uint32_t>(recordWords)};
    tables_ = {};
    tableWords_.clear();
    generations_.clear();
    coincident_.clear();
    coincidentKey_ = {};
    shadowsKey_ = {};
    if (has(needs, SceneData::positions)) words_.put(bytesOf(std::vector<std::uint32_t>(recordWords)));
}

std::uint32_t GpuScene::putWords(Resident& resident, const std::vector<std::uint32_t>& values) {
    if (values.empty()) return kNoWords;
    resident.words.push_back(words_.put(bytesOf(values)));
    return resident.words.back().first;
}

void GpuScene::putMesh(const ContentKey& key, const TriMesh& mesh) {
    Resident& resident = residents_[key];
    resident.segments = mesh.segments;
    resident.positions = positions_.put(bytesOf(mesh.positions));
    resident.triangles = triangles_.put(bytesOf(mesh.indices));
    if (has(needs_, SceneData::normals)) resident.normals = normals_.put(bytesOf(mesh.normals));
    if (has(needs_, SceneData::uvs)) resident.uvs = uvs_.put(bytesOf(mesh.uvs));
    // These two lie parallel to the triangles: shaders find them by the same number.
    const bool hasOwnIndices = !has(needs_, SceneData::unifiedVertices);
    if (hasOwnIndices && has(needs_, SceneData::normals))
        resident.triangleNormals = triangleNormals_.put(bytesOf(besideTriangles(mesh.normalIndices, mesh)));
    if (hasOwnIndices && has(needs_, SceneData::uvs))
        resident.triangleUvs = triangleUvs_.put(bytesOf(besideTriangles(mesh.uvIndices, mesh)));
    assert(resident.triangleNormals.count == 0 || resident.triangleNormals.first == resident.triangles.first);
    assert(resident.triangleUvs.count == 0 || resident.triangleUvs.first == resident.triangles.first);
    resident.place = {resident.positions.first, resident.normals.first, resident.uvs.first, resident.triangles.first,
        static_cast<std::uint32_t>(mesh.triangleCount()), kNoWords, kNoWords, kNoWords, mesh.pivot};
    if (has(needs_, SceneData::materials)) resident.place.materialWords = putWords(resident, mesh.triangleMaterial);
    resident.place.partWords = putWords(resident, mesh.trianglePart);
    if (has(needs_, SceneData::colors)) resident.place.colorWords = putWords(resident, packColors(mesh));
}

void GpuScene::dropMesh(const Resident& resident) {
    positions_.drop(resident.positions);
    triangles_.drop(resident.triangles);
    normals_.drop(resident.normals);
    uvs_.drop(resident.uvs);
    triangleNormals_.drop(resident.triangleNormals);
    triangleUvs_.drop(resident.triangleUvs);
    for (const auto& piece : resident.words) words_.drop(piece);
}

void GpuScene::putMeshes(std::span<const ContentKey> meshOf, const std::map<ContentKey, TriMesh>& made) {
    const std::set<ContentKey> wanted(meshOf.begin(), meshOf.end());
    for (auto resident = residents_.begin(); resident != residents_.end();)
        if (wanted.contains(resident->first)) {
            ++resident;
        } else {
            dropMesh(resident->second);
            resident = residents_.erase(resident);
        }
    std::vector<std::pair<ContentKey, const TriMesh*>> missing;
    std::uint64_t vertices = 0, triangles = 0, normals = 0, uvs = 0;
    for (const auto& key : wanted) {
        if (residents_.contains(key)) continue;
        const TriMesh& mesh = made.at(key);
        missing.emplace_back(key, &mesh);
        vertices += mesh.positions.size();
        triangles += mesh.triangleCount();
        normals += mesh.normals.size();
        uvs += mesh.uvs.size();
    }
    if (residents_.empty()) {  // the first time reserves exactly the size needed
        const bool hasOwnIndices = !has(needs_, SceneData::unifiedVertices);
        positions_.reserve(vertices);
        triangles_.reserve(triangles);
        if (has(needs_, SceneData::normals)) normals_.reserve(normals);
        if (has(needs_, SceneData::uvs)) uvs_.reserve(uvs);
        if (hasOwnIndices && has(needs_, SceneData::normals)) triangleNormals_.reserve(triangles);
        if (hasOwnIndices && has(needs_, SceneData::uvs)) triangleUvs_.reserve(triangles);
    }
    for (const auto& [key, mesh] : missing) putMesh(key, *mesh);
    shown_.clear();
    for (const auto& key : meshOf) shown_.push_back(&residents_.at(key));

    std::size_t drawn = 0;
    for (const Resident* resident : shown_) drawn += resident->place.triangleCount;
    isCullable_ = isSoftware_ && drawn >= kManyTriangles;
    if (!isCullable_) return;
    for (const auto& [key, mesh] : missing) residents_.at(key).clusters = makeClusters(*mesh);
    // Additions may make a scene large. Meshes from before have no clusters, so it is drawn whole until they change.
    for (const Resident* resident : shown_)
        isCullable_ = isCullable_ && (!resident->clusters.empty() || resident->place.triangleCount == 0);
}

void GpuScene::putTables(const SceneAt& scene) {
    std::vector<std::uint32_t> words;
    for (const auto& record : scene.lineRecords)
        for (const auto word : lineRecordWords(record)) words.push_back(word);
    const std::size_t recordWords = words.size();
    materialTables_.clear();
    for (const auto& instance : scene.instances) {
        materialTables_.push_back(static_cast<std::uint32_t>(words.size() - recordWords));
        for (std::size_t i = 0; i < instance.materials.size(); ++i)
            words.insert(words.end(), {instance.materials[i], instance.lineRecords[i]});
    }
    const std::span<const std::uint32_t> all(words), tables = all.subspan(recordWords);
    if (words != tableWords_ || recordWords != recordWords_) {
        words_.write({0, static_cast<std::uint32_t>(recordWords)}, std::as_bytes(all.first(recordWords)));
        if (tables_.count == tables.size()) {
            words_.write(tables_, std::as_bytes(tables));
        } else {
            words_.drop(tables_);
            tables_ = words_.put(std::as_bytes(tables));
        }
        tableWords_ = words;
        recordWords_ = recordWords;
    }
    for (auto& table : materialTables_) table += tables_.first;
}

void GpuScene::putCommands() {
    std::vector<gl::DrawCommand> commands, alone;
    std::vector<std::uint32_t> numbers;
    for (const Resident* resident : shown_) {
        const MeshPlace& place = resident->place;
        const auto number = static_cast<std::uint32_t>(numbers.size());
        numbers.push_back(number);
        const auto run = [&](std::uint32_t from, std::uint32_t to) {
            return gl::DrawCommand{(to - from) * 3, 1, (place.firstTriangle + from) * 3,
                static_cast<std::int32_t>(place.firstVertex), number};
        };
        commands.push_back(run(0, place.triangleCount));
        std::uint32_t from = 0;
        for (const std::uint32_t triangle : coincident_.drawnHere(number)) {
            if (triangle > from) alone.push_back(run(from, triangle));
            from = triangle + 1;
        }
        if (place.triangleCount > from) alone.push_back(run(from, place.triangleCount));
    }
    putChanged(commands_, commandBytes_, bytesOf(commands), "draw commands");
    aloneCount_ = static_cast<int>(alone.size());
    if (!alone.empty()) putChanged(aloneCommands_, aloneBytes_, bytesOf(alone), "draw commands");
    if (putChanged(instanceNumbers_, numberBytes_, bytesOf(numbers), "instance numbers")) generations_.clear();
}

void GpuScene::putMarks(const SceneAt& scene) {
    marks_.clear();
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        const DrawInstance& instance = scene.instances[i];
        const auto place = [&](const glm::vec3& p) {
            return glm::dvec3(instance.worldFromMesh * glm::dvec4(shown_[i]->place.pivot + glm::dvec3(p), 1));
        };
        for (const Segment& segment : shown_[i]->segments) {
            const std::uint32_t record = instance.lineRecords[segment.material];
            if (scene.lineRecords[record].draws)
                marks_.push_back({place(segment.a), place(segment.b), record, segment.isCut});
        }
    }
}

void GpuScene::putShadows(const SceneAt& scene, std::span<const ContentKey> meshOf) {
    const ContentKey key = limn::shadowsKey(scene, meshOf);
    if (key == shadowsKey_) return;
    shadowsKey_ = key;
    std::vector<glm::mat4> places;
    const auto projections = shadowProjections(scene);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const glm::dmat4& world = scene.instances[i].worldFromMesh;
        for (const auto& projection : projections) {
            glm::dmat4 relativeFromMesh(glm::dmat3{world});
            relativeFromMesh[3] =
                glm::dvec4(glm::dvec3(world * glm::dvec4(shown_[i]->place.pivot, 1)) - projection.origin, 1);
            places.emplace_back(projection.clipFromRelative * relativeFromMesh);
        }
    }
    shadowPlaces_ = gl::Buffer(bytesOf(places), "shadow places");
    shadowPlacesView_ = gl::BufferView(shadowPlaces_, gl::Element::float4, "shadow places");
}

void GpuScene::putCoincident(const SceneAt& scene, std::span<const ContentKey> meshOf) {
    KeyBuilder key;
    std::vector<std::uint32_t> instances;
    for (std::uint32_t i = 0; i < shown_.size(); ++i) {
        if (scene.instances[i].isSubdivided || shown_[i]->place.triangleCount == 0) continue;
        const glm::dmat4& world = scene.instances[i].worldFromMesh;
        key.add(i).add(meshOf[i].low).add(meshOf[i].high).bytes(&world, sizeof world);
        instances.push_back(i);
    }
    if (key.key() == coincidentKey_) return;
    coincidentKey_ = key.key();
    std::map<const Resident*, std::pair<std::vector<std::byte>, std::vector<std::byte>>> read;
    std::vector<PlacedTriangles> meshes;
    std::vector<std::int32_t> firstVertices;
    for (const auto i : instances) {
        const Resident& mesh = *shown_[i];
        const auto [it, isNew] = read.try_emplace(&mesh);
        auto& [points, corners] = it->second;
        if (isNew) {
            points = positions_.read(mesh.positions);
            corners = triangles_.read(mesh.triangles);
        }
        meshes.push_back({{reinterpret_cast<const glm::vec3*>(points.data()), mesh.positions.count},
            {reinterpret_cast<const std::uint32_t*>(corners.data()), 3 * std::size_t{mesh.triangles.count}},
            glm::translate(scene.instances[i].worldFromMesh, mesh.place.pivot)});
        firstVertices.push_back(static_cast<std::int32_t>(mesh.place.firstVertex));
    }
    coincident_.find(meshes, instances, firstVertices);
}

void GpuScene::connect() {
    const std::vector<int> generations{positions_.generation(), triangles_.generation(), normals_.generation(),
        triangleNormals_.generation(), uvs_.generation(), triangleUvs_.generation(), words_.generation()};
    if (generations == generations_) return;
    generations_ = generations;
    const auto view = [](const Arena& arena, gl::Element element, const char* label) {
        return arena.buffer() ? gl::BufferView(arena.buffer(), element, label) : gl::BufferView();
    };
    positionsView_ = view(positions_, gl::Element::float3, "positions");
    trianglesView_ = view(triangles_, gl::Element::uint3, "triangles");
    normalsView_ = view(normals_, gl::Element::float3, "normals");
    triangleNormalsView_ = view(triangleNormals_, gl::Element::uint3, "triangles' normals");
    uvsView_ = view(uvs_, gl::Element::float2, "uvs");
    triangleUvsView_ = view(triangleUvs_, gl::Element::uint3, "triangles' uvs");
    wordsView_ = view(words_, gl::Element::uint1, "words");
    // Vertex pipelines take normals and uvs by the vertex's own number.
    const bool isUnified = has(needs_, SceneData::unifiedVertices);
    inputs_ = {{&positions_.buffer(), 0, 3}, {&instanceNumbers_, 1, 0}};
    if (isUnified && has(needs_, SceneData::normals)) inputs_.push_back({&normals_.buffer(), 2, 3});
    if (isUnified && has(needs_, SceneData::uvs)) inputs_.push_back({&uvs_.buffer(), 3, 2});
    vertexArray_ = gl::VertexArray(inputs_, triangles_.buffer(), "scene");
}

void GpuScene::update(
    const SceneAt& scene, std::span<const ContentKey> meshOf, const std::map<ContentKey, TriMesh>& made) {
    isReady_ = !has(needs_, SceneData::positions);
    if (isReady_) return;
    const auto mostLights = static_cast<std::size_t>(limits_.maxUniformBlock) / lightSize();
    if (has(needs_, SceneData::lights) && scene.lights.size() > mostLights)
        throw Error(ExitCode::badData, {},
            fmt::format(
                "the scene has {} lights, more than this GL device takes ({})", scene.lights.size(), mostLights),
            "remove some");
    putMeshes(meshOf, made);
    putTables(scene);
    if (has(needs_, SceneData::coincidence)) putCoincident(scene, meshOf);
    putCommands();
    if (has(needs_, SceneData::marks)) putMarks(scene);
    if (has(needs_, SceneData::shadows)) putShadows(scene, meshOf);
    connect();
    if (has(needs_, SceneData::textures)) atlas_.update(scene, limits_.maxTextureSize);
    if (has(needs_, SceneData::materials)) putMaterials(scene);
    isReady_ = true;
}

void GpuScene::putMaterials(const SceneAt& scene) {
    std::vector<GpuMaterial> materials;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        materials.push_back(
            packMaterial(scene.materials[i], has(needs_, SceneData::textures) ? atlas_.places()[i] : AtlasPlace()));
    if (putChanged(materials_, materialBytes_, bytesOf(materials), "materials"))
        materialsView_ = gl::BufferView(materials_, gl::Element::float4, "materials");
}

std::vector<std::byte> GpuScene::instanceBytes(const SceneAt& scene, const View& view) const {
    std::vector<GpuInstance> instances;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto& instance = scene.instances[i];
        const MeshPlace& place = shown_[i]->place;
        const auto [linear, pivot] = placementOf(instance, place.pivot, view);
        const glm::dmat3 inverse = glm::inverse(linear);
        const glm::dvec3 offset = inverse * -pivot;
        GpuInstance gpu{};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                gpu.meshFromView[row][column] = inverse[column][row];
                gpu.viewFromMesh[row][column] = static_cast<float>(linear[column][row]);
            }
            gpu.meshFromView[row][3] = offset[row];
            gpu.viewFromMesh[row][3] = static_cast<float>(pivot[row]);
        }
        gpu.firstVertex = place.firstVertex;
        gpu.firstTriangle = place.firstTriangle;
        gpu.materialTable = materialTables_[i];
        gpu.firstObject = instance.firstObject;
        gpu.materialWords = place.materialWords;
        gpu.partWords = place.partWords;
        gpu.firstNormal = place.firstNormal;
        gpu.firstUv = place.firstUv;
        gpu.triangleCount = place.triangleCount;
        gpu.colorWords = place.colorWords;
        instances.push_back(gpu);
    }
    const auto bytes = bytesOf(instances);
    return {bytes.begin(), bytes.end()};
}

void GpuScene::placeMeshes(const SceneAt& scene, const View& view) {
    const glm::vec2 low((view.region.origin - view.canvas.origin) * view.sampling.raster);
    cullView_ = {{}, low, low + glm::vec2(view.region.size * view.sampling.raster), view.orthographic};
    // Clip space spans the canvas: −1 … 1 become its fine pixels.
    const glm::dvec2 half = 0.5 * glm::dvec2(view.canvas.size * view.sampling.raster);
    glm::dmat4 pixelFromClip(1);
    pixelFromClip[0][0] = half.x;
    pixelFromClip[1][1] = half.y;
    pixelFromClip[3][0] = half.x;
    pixelFromClip[3][1] = half.y;
    const glm::dmat4 pixelFromView = pixelFromClip * view.clipFromView();
    const auto absolute = [](glm::dmat4 m) {
        for (int column = 0; column < 4; ++column) m[column] = glm::abs(m[column]);
        return m;
    };
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const MeshPlace& place = shown_[i]->place;
        const auto [linear, pivot] = placementOf(scene.instances[i], place.pivot, view);
        glm::dmat4 viewFromMesh(linear);
        viewFromMesh[3] = glm::dvec4(pivot, 1);
        PlacedMesh mesh{shown_[i]->clusters, place.firstVertex, 3 * std::size_t{place.firstTriangle},
            glm::mat4(pixelFromView * viewFromMesh), glm::mat4(absolute(pixelFromView) * absolute(viewFromMesh)), {}};
        // The eye is view space's origin; parallel rays come along its z axis.
        mesh.eye = glm::inverse(linear) * (view.orthographic ? glm::dvec3(0, 0, 1) : -pivot);
        cullView_.instances.push_back(mesh);
    }
}

void GpuScene::setView(const SceneAt& scene, const View& view) {
    if (!has(needs_, SceneData::positions)) return;
    if (isCullable_) placeMeshes(scene, view);
    const auto put = [&](gl::Buffer& buffer, const std::vector<std::byte>& data, const char* label) {
        if (!buffer || buffer.size() != data.size())
            buffer = gl::Buffer(data, label);
        else
            buffer.write(data);
    };
    put(instances_, instanceBytes(scene, view), "instances");
    instancesView_ = gl::BufferView(instances_, gl::Element::uint4, "instances");
    if (has(needs_, SceneData::lights)) put(lights_, lightBytes(scene, view), "lights");
}

void GpuScene::setPrevious(const SceneAt& scene, const SceneAt& previous, const View& view) {
    std::map<std::size_t, const DrawInstance*> before;
    for (const auto& instance : previous.instances) before[instance.source] = &instance;
    std::vector<glm::vec4> rows;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto known = before.find(scene.instances[i].source);
        if (known == before.end()) {
            rows.resize(rows.size() + 3);  // w = 0: it was not there
            continue;
        }
        const auto [linear, pivot] = placementOf(*known->second, shown_[i]->place.pivot, view);
        const glm::dmat3 byRow = glm::transpose(linear);
        const glm::dvec4 x(byRow[0], pivot.x), y(byRow[1], pivot.y), depth(-byRow[2], -pivot.z);
        // A ray's xy at unit depth is pixel * scale + offset (picture/view.h).
        const glm::dvec4 w = view.orthographic ? glm::dvec4(0, 0, 0, 1) : depth;
        rows.emplace_back((x - view.rayOffset.x * w) / view.rayScale.x);
        rows.emplace_back((y - view.rayOffset.y * w) / view.rayScale.y);
        rows.emplace_back(w);
    }
    if (rows.empty()) rows.resize(3);
    const auto bytes = bytesOf(rows);
    if (!previous_ || previous_.size() != bytes.size())
        previous_ = gl::Buffer(bytes, "previous places");
    else
        previous_.write(bytes);
    previousView_ = gl::BufferView(previous_, gl::Element::float4, "previous places");
}

void GpuScene::bind() const {
    if (!has(needs_, SceneData::positions)) return;
    positionsView_.bind(positionsUnit);
    trianglesView_.bind(trianglesUnit);
    wordsView_.bind(wordsUnit);
    instancesView_.bind(instancesUnit);
    if (normalsView_) normalsView_.bind(normalsUnit);
    if (uvsView_) uvsView_.bind(uvsUnit);
    if (triangleNormalsView_) triangleNormalsView_.bind(triangleNormalsUnit);
    if (triangleUvsView_) triangleUvsView_.bind(triangleUvsUnit);
    if (materialsView_) materialsView_.bind(materialsUnit);
    if (previousView_) previousView_.bind(previousUnit);
    if (shadowPlacesView_) shadowPlacesView_.bind(shadowPlacesUnit);
    if (lights_) lights_.bindUniform(kLightsBinding);
    if (atlas_.texture()) atlas_.texture().bindSampler(atlasUnit);
}

void GpuScene::draw() const {
    vertexArray_.bind();
    gl::drawElements(commands_, static_cast<int>(shown_.size()));
}

void GpuScene::drawAlone() const {
    vertexArray_.bind();
    if (aloneCount_ > 0) gl::drawElements(aloneCommands_, aloneCount_);
}

void GpuScene::drawSeen(const FarthestDepths* farthest) {
    const gl::Mapping positions(positions_.buffer()), indices(triangles_.buffer());
    const TriangleSource source{
        reinterpret_cast<const glm::vec3*>(positions.bytes()), reinterpret_cast<const std::uint32_t*>(indices.bytes())};
    if (!farthest) parts_ = partsOf(cullView_);
    // Draws some at a time: the renderer's threads draw them while this thread sets up the next and others choose
    // further ones.
    constexpr std::size_t kCorners = 3 * 20'000;
    std::vector<std::uint32_t> corners;
    std::vector<gl::DrawCommand> commands;
    const auto drawThem = [&] {
        if (corners.empty()) return;
        const gl::Buffer elements(bytesOf(corners), "seen triangles"), calls(bytesOf(commands), "draw commands");
        const gl::VertexArray array(inputs_, elements, "seen triangles");
        array.bind();
        gl::drawElements(calls, static_cast<int>(commands.size()));
        gl::flush();
        corners.clear();
        commands.clear();
    };
    inOrder(
        parts_.size(),
        [&](std::size_t i) {
            if (farthest)
                chooseBacks(cullView_, source, *farthest, parts_[i]);
            else
                chooseFacing(cullView_, source, parts_[i]);
        },
        [&](std::size_t i) {
            auto& part = parts_[i];
            leaveOut(coincident_.drawnHere(static_cast<std::uint32_t>(part.instance)), part.indices);
            if (part.indices.empty()) return;
            const auto first = static_cast<std::int32_t>(shown_[part.instance]->place.firstVertex);
            commands.push_back({static_cast<std::uint32_t>(part.indices.size()), 1,
                static_cast<std::uint32_t>(corners.size()), first, static_cast<std::uint32_t>(part.instance)});
            corners.insert(corners.end(), part.indices.begin(), part.indices.end());
            part.indices = {};
            if (corners.size() >= kCorners) drawThem();
        });
    drawThem();
}

}  // namespace limn
