#include "frame/gpu_scene.h"

#include "base/color.h"
#include "base/error.h"
#include "base/in_order.h"
#include "base/text.h"
#include "frame/texture.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace limn {
namespace {

// Texture units of the buffers in shaders/frame/scene.glsl and of the atlas in shaders/lib/texture.glsl.
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
    atlasUnit
};
constexpr int kLightsBinding = 2;

// One instance, as shaders/frame/scene.glsl fetches it: twelve texels of sixteen bytes.
struct GpuInstance {
    double meshFromView[3][4];
    float viewFromMesh[3][4];
    std::uint32_t firstVertex, firstTriangle, materialTable, firstObject;
    std::uint32_t materialWords, partWords, firstNormal, firstUv;
    std::uint32_t triangleCount, colorWords, padding[2];
};
static_assert(sizeof(GpuInstance) == 12 * 16);

// Five texels.
struct GpuMaterial {
    float color[3], levels;
    float shininess, specular, layer, flags;
    float place[4];
    float hatchX, hatchY, hatchWidth, padding2;
    float hatchColor[4];
};
static_assert(sizeof(GpuMaterial) == 5 * 16);

// std140, as in shaders/frame/lights.glsl.
struct GpuLight {
    glm::vec4 direction, position, color, cone, shadow;
    glm::vec4 shadowPlace[6];
    glm::mat4 shadowFromView[6];
};
static_assert(sizeof(GpuLight) == 560);

// Of GpuMaterial::flags.
constexpr int kHasHoles = 1, kTakesVertexColors = 2;

constexpr std::uint32_t kNoWords = ~0u;

// Scenes with fewer triangles are always drawn whole: even software renderers take but some milliseconds.
constexpr std::size_t kManyTriangles = 1 << 16;

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

std::uint64_t countAll(std::span<const TriMesh> meshes, auto member) {
    std::uint64_t count = 0;
    for (const auto& mesh : meshes) count += (mesh.*member).size();
    return count;
}

template <class T>
std::vector<T> concatenate(std::span<const TriMesh> meshes, std::vector<T> TriMesh::*member) {
    std::vector<T> all;
    all.reserve(countAll(meshes, member));
    for (const auto& mesh : meshes) all.insert(all.end(), (mesh.*member).begin(), (mesh.*member).end());
    return all;
}

/// Vertex colours as shaders/frame/scene.glsl reads them: ten display-encoded bits each; of each corner of each
/// triangle, or of each vertex where those are unified.
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

/// A scale of 0 flattens a mesh, which is a fair thing to ask for but leaves no way back from the view: a billionth of
/// the size does both.
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

/// Where an instance's mesh is, seen from its pivot: normalized view space from mesh units.
struct Placement {
    glm::dmat3 linear;
    glm::dvec3 pivot;
};

Placement placementOf(const DrawInstance& instance, const glm::dvec3& pivot, const View& view) {
    return {invertible(view.viewFromRelative * glm::dmat3(instance.worldFromMesh)),
        view.toView(glm::dvec3(instance.worldFromMesh * glm::dvec4(pivot, 1)))};
}

/// Reversed-depth perspective over `fov` (full angle, radians), square.
glm::dmat4 lightPerspective(double fov, double near) {
    const double f = 1 / std::tan(fov / 2);
    glm::dmat4 m(0);
    m[0][0] = m[1][1] = f;
    m[2][3] = -1;
    m[3][2] = near;
    return m;
}

/// A view along `forward`, with any up.
glm::dmat4 lookAlong(const glm::dvec3& position, const glm::dvec3& forward) {
    const glm::dvec3 up = std::abs(forward.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return glm::lookAt(position, position + forward, up);
}

constexpr glm::dvec3 kCubeFaces[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Clip space of the light's map from normalized view space.
std::vector<glm::dmat4> shadowMatrices(const Light& light, const SceneInfo& scene, const View& view) {
    // World directions and lengths, counted from the eye.
    const glm::dmat4 relativeFromView(glm::transpose(view.viewFromRelative) / (view.unit * view.unit));
    if (light.kind == LightKind::sun) {
        // A sphere around the scene keeps the map's texels still while the camera moves.
        const double radius = scene.diagonal() / 2;
        const glm::dvec3 forward = glm::normalize(light.direction);
        const glm::dmat4 lightView = lookAlong(scene.bounds.centre() - view.eye - forward * radius * 2.0, forward);
        glm::dmat4 clip(1);
        clip[0][0] = clip[1][1] = 1 / radius;
        // Depths radius … 3·radius → 1 … 0.
        clip[2][2] = 1 / (2 * radius);
        clip[3][2] = 1.5;
        return {clip * lightView * relativeFromView};
    }
    const double near = scene.diagonal() * 1e-4;
    if (light.kind == LightKind::spot)
        return {lightPerspective(glm::radians(light.angle), near)
            * lookAlong(light.position - view.eye, glm::normalize(light.direction)) * relativeFromView};
    std::vector<glm::dmat4> faces;
    for (const auto& forward : kCubeFaces)
        faces.push_back(lightPerspective(glm::radians(90.0), near) * lookAlong(light.position - view.eye, forward)
            * relativeFromView);
    return faces;
}

}  // namespace

ShadowLayout shadowLayout(std::span<const Light> lights) {
    constexpr int kRow = 8192;  // maps stand side by side up to here, then in the next row
    ShadowLayout layout;
    glm::ivec2 pen(0);
    int rowHeight = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (!lights[l].shadow.present) continue;
        const int side = lights[l].shadow.resolution;
        for (int face = 0; face < (lights[l].kind == LightKind::point ? 6 : 1); ++face) {
            if (pen.x > 0 && pen.x + side > kRow) {
                pen = {0, pen.y + rowHeight};
                rowHeight = 0;
            }
            layout.drawings.push_back({{pen, side, side}, static_cast<int>(l) * 8 + face});
            pen.x += side;
            rowHeight = std::max(rowHeight, side);
            layout.size = glm::max(layout.size, glm::ivec2(pen.x, pen.y + rowHeight));
        }
    }
    return layout;
}

GpuScene::GpuScene(const DrawScene& scene, std::span<const TriMesh> meshes, std::span<const int> meshOf,
    SceneData needs, const gl::Limits& limits, bool cullable)
    : needs_(needs), meshOf_(meshOf.begin(), meshOf.end()) {
    if (!has(needs, SceneData::positions)) return;
    const auto most = static_cast<std::uint64_t>(limits.maxBufferTexels);
    if (countAll(meshes, &TriMesh::indices) / 3 > most || countAll(meshes, &TriMesh::positions) > most)
        throw Error(ExitCode::outOfMemory, {},
            fmt::format("the scene has more triangles or vertices than this GL device takes ({})", most),
            "use coarser meshes or another device");

    if (const auto mostLights = static_cast<std::size_t>(limits.maxUniformBlock) / sizeof(GpuLight);
        has(needs, SceneData::lights) && scene.lights.size() > mostLights)
        throw Error(ExitCode::badData, {},
            fmt::format(
                "the scene has {} lights, more than this GL device takes ({})", scene.lights.size(), mostLights),
            "remove some");

    std::vector<std::uint32_t> words;
    for (const auto& record : scene.lineRecords) {
        const float numbers[] = {record.color.color.r, record.color.color.g, record.color.color.b,
            record.creaseAngle > 0 ? static_cast<float>(std::cos(glm::radians(record.creaseAngle))) : -2.0f};
        for (const float number : numbers) words.push_back(std::bit_cast<std::uint32_t>(number));
        words.push_back((record.draws ? 1u : 0u) | (record.color.given ? 2u : 0u) | (record.isCut ? 4u : 0u));
    }
    std::uint32_t vertices = 0, triangles = 0, normals = 0, uvs = 0;
    for (const auto& mesh : meshes) {
        MeshPlace place{vertices, normals, uvs, triangles, static_cast<std::uint32_t>(mesh.triangleCount()), kNoWords,
            kNoWords, kNoWords, mesh.pivot};
        const auto addWords = [&](const std::vector<std::uint32_t>& values) {
            if (values.empty()) return kNoWords;
            words.insert(words.end(), values.begin(), values.end());
            return static_cast<std::uint32_t>(words.size() - values.size());
        };
        if (has(needs, SceneData::materials)) place.materialWords = addWords(mesh.triangleMaterial);
        place.partWords = addWords(mesh.trianglePart);
        if (has(needs, SceneData::colors)) place.colorWords = addWords(packColors(mesh));
        vertices += static_cast<std::uint32_t>(mesh.positions.size());
        normals += static_cast<std::uint32_t>(mesh.normals.size());
        uvs += static_cast<std::uint32_t>(mesh.uvs.size());
        triangles += place.triangleCount;
        places_.push_back(place);
    }
    std::vector<gl::DrawCommand> commands;
    std::vector<std::uint32_t> numbers;
    for (const auto& instance : scene.instances) {
        const auto& place = places_[static_cast<std::size_t>(meshOf_[numbers.size()])];
        materialTables_.push_back(static_cast<std::uint32_t>(words.size()));
        for (std::size_t i = 0; i < instance.materials.size(); ++i)
            words.insert(words.end(), {instance.materials[i], instance.lineRecords[i]});
        const auto number = static_cast<std::uint32_t>(numbers.size());
        commands.push_back({place.triangleCount * 3, 1, place.firstTriangle * 3,
            static_cast<std::int32_t>(place.firstVertex), number});
        numbers.push_back(number);
    }
    if (words.size() > most)
        throw Error(ExitCode::outOfMemory, {},
            fmt::format("the scene's triangles have more materials, parts and vertex colours than this GL device takes "
                        "({} numbers)",
                most),
            "use coarser meshes or another device");
    std::size_t drawn = 0;
    for (const auto& command : commands) drawn += command.count / 3;
    if (cullable && drawn >= kManyTriangles)
        for (const auto& mesh : meshes) clusters_.push_back(makeClusters(mesh));
    positions_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::positions)), "positions", !clusters_.empty());
    indices_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::indices)), "triangles", !clusters_.empty());
    words_ = gl::Buffer(bytesOf(words), "words");
    commands_ = gl::Buffer(bytesOf(commands), "draw commands");
    instanceNumbers_ = gl::Buffer(bytesOf(numbers), "instance numbers");
    positionsView_ = gl::BufferView(positions_, gl::Element::float3, "positions");
    trianglesView_ = gl::BufferView(indices_, gl::Element::uint3, "triangles");
    wordsView_ = gl::BufferView(words_, gl::Element::uint1, "words");
    // Meshes are all of one layout: unified for vertex pipelines, or with indices of their own for each attribute.
    const bool hasOwnIndices = countAll(meshes, &TriMesh::normalIndices) + countAll(meshes, &TriMesh::uvIndices) > 0;
    std::vector<gl::VertexInput> inputs{{&positions_, 0, 3}, {&instanceNumbers_, 1, 0}};
    if (has(needs, SceneData::normals)) {
        normals_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::normals)), "normals");
        normalsView_ = gl::BufferView(normals_, gl::Element::float3, "normals");
        if (hasOwnIndices) {
            normalIndices_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::normalIndices)), "triangles' normals");
            triangleNormalsView_ = gl::BufferView(normalIndices_, gl::Element::uint3, "triangles' normals");
        } else {
            inputs.push_back({&normals_, 2, 3});
        }
    }
    if (has(needs, SceneData::uvs)) {
        uvs_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::uvs)), "uvs");
        uvsView_ = gl::BufferView(uvs_, gl::Element::float2, "uvs");
        if (hasOwnIndices) {
            uvIndices_ = gl::Buffer(bytesOf(concatenate(meshes, &TriMesh::uvIndices)), "triangles' uvs");
            triangleUvsView_ = gl::BufferView(uvIndices_, gl::Element::uint3, "triangles' uvs");
        } else {
            inputs.push_back({&uvs_, 3, 2});
        }
    }
    vertexArray_ = gl::VertexArray(inputs, indices_, "scene");
    inputs_ = std::move(inputs);

    atlasEntries_.resize(scene.materials.size());
    if (has(needs, SceneData::textures)) loadTextures(scene, limits.maxTextureSize);
    if (has(needs, SceneData::materials)) {
        std::vector<GpuMaterial> gpuMaterials;
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            const auto& m = scene.materials[i];
            const auto& entry = atlasEntries_[i];
            const auto number = [](int value) { return static_cast<float>(value); };
            gpuMaterials.push_back({{m.color.r, m.color.g, m.color.b}, number(entry.levels), m.shininess, m.specular,
                number(entry.place.z),
                number((m.cutout.empty() ? 0 : kHasHoles) | (m.vertexColors ? kTakesVertexColors : 0)),
                {number(entry.place.x), number(entry.place.y), number(entry.size.x), number(entry.size.y)}, 0, 0,
                static_cast<float>(m.hatch.width), 0, {m.hatch.color.r, m.hatch.color.g, m.hatch.color.b, 0}});
            // Across the lines, one per distance between them.
            if (m.hatch.spacing > 0) {
                gpuMaterials.back().hatchX =
                    static_cast<float>(-std::sin(glm::radians(m.hatch.angle)) / m.hatch.spacing);
                gpuMaterials.back().hatchY =
                    static_cast<float>(std::cos(glm::radians(m.hatch.angle)) / m.hatch.spacing);
            }
        }
        materials_ = gl::Buffer(bytesOf(gpuMaterials), "materials");
        materialsView_ = gl::BufferView(materials_, gl::Element::float4, "materials");
    }
}

void GpuScene::loadTextures(const DrawScene& scene, int maxTextureSize) {
    using Files = std::pair<std::string, std::string>;  // of colours, and of holes
    const auto filesOf = [](const Material& material) { return Files(material.texture, material.cutout); };
    std::map<Files, MipChain> chains;
    for (const auto& material : scene.materials)
        if (!material.texture.empty() || !material.cutout.empty()) chains[filesOf(material)];
    if (chains.empty()) return;
    for (auto& [files, chain] : chains)
        chain = makeMipChain(readTexture(files.first, files.second), !files.second.empty());

    // Shelves: tallest first, left to right, then the next shelf, then the next layer.
    std::vector<std::pair<Files, const MipChain*>> order;
    int side = 256;
    for (const auto& [files, chain] : chains) {
        order.emplace_back(files, &chain);
        const glm::ivec2 footprint = chain.footprint();
        while (side < std::max(footprint.x, footprint.y)) side *= 2;
        if (side > maxTextureSize)
            throw Error(ExitCode::outOfMemory, {files.first.empty() ? files.second : files.first},
                fmt::format("the texture of {}×{} is larger than this GL device allows", chain.size.x, chain.size.y),
                "make it smaller");
    }
    std::stable_sort(order.begin(), order.end(),
        [](const auto& a, const auto& b) { return a.second->footprint().y > b.second->footprint().y; });
    std::map<Files, glm::ivec3> places;
    glm::ivec3 pen(0);
    int shelf = 0;
    for (const auto& [files, chain] : order) {
        const glm::ivec2 footprint = chain->footprint();
        if (pen.x + footprint.x > side) {
            pen.x = 0;
            pen.y += shelf;
            shelf = 0;
        }
        if (pen.y + footprint.y > side) {
            pen = {0, 0, pen.z + 1};
            shelf = 0;
        }
        places[files] = pen;
        pen.x += footprint.x;
        shelf = std::max(shelf, footprint.y);
    }
    atlas_ = gl::Texture::pictureArray(side, pen.z + 1, "texture atlas");
    for (const auto& [files, chain] : chains)
        for (int l = 0; l < chain.levels(); ++l)
            atlas_.writeLayer(places[files].z, glm::ivec2(places[files]) + chain.levelOrigin(l), chain.levelSize(l),
                chain.pixels[static_cast<std::size_t>(l)].data());
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const auto known = chains.find(filesOf(scene.materials[i]));
        if (known != chains.end())
            atlasEntries_[i] = {places[known->first], known->second.levels(), known->second.size};
    }
}

std::vector<std::byte> GpuScene::instanceBytes(const DrawScene& scene, const View& view) const {
    std::vector<GpuInstance> instances;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto& instance = scene.instances[i];
        const auto& place = places_[static_cast<std::size_t>(meshOf_[i])];
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

std::vector<std::byte> GpuScene::lightBytes(const DrawScene& scene, const View& view) const {
    std::vector<GpuLight> lights;
    const ShadowLayout layout = shadowLayout(scene.lights);
    for (const auto& light : scene.lights) {
        GpuLight gpu{};
        const glm::dvec3 towards =
            light.kind == LightKind::point ? glm::dvec3(0) : -glm::normalize(view.viewFromRelative * light.direction);
        gpu.direction = glm::vec4(glm::vec3(towards), static_cast<float>(light.kind));
        gpu.position = glm::vec4(glm::vec3(view.toView(light.position)),
            light.range > 0 ? static_cast<float>(1 / (light.range * view.unit)) : 0.0f);
        gpu.color = glm::vec4(light.color.r, light.color.g, light.color.b, 0) * static_cast<float>(light.intensity);
        const double half = glm::radians(light.angle) / 2;
        // A hard edge is a very narrow one: smoothstep needs its ends apart.
        gpu.cone = {std::cos(half), std::max(std::cos(half * (1 - light.blend)), std::cos(half) + 1e-6), 0, 0};
        if (light.shadow.present) {
            const double texelAtUnit = light.kind == LightKind::sun
                ? scene.info.diagonal() * view.unit / light.shadow.resolution
                : light.kind == LightKind::spot ? 2 * std::tan(half) / light.shadow.resolution
                                                : 2.0 / light.shadow.resolution;
            gpu.shadow = {texelAtUnit, light.shadow.softness, 0, 1};
            for (const auto& drawing : layout.drawings)
                if (drawing.number / 8 == static_cast<int>(lights.size()))
                    gpu.shadowPlace[drawing.number % 8] = glm::vec4(drawing.viewport);
            const auto matrices = shadowMatrices(light, scene.info, view);
            for (std::size_t m = 0; m < matrices.size(); ++m) gpu.shadowFromView[m] = matrices[m];
        }
        lights.push_back(gpu);
    }
    const auto bytes = bytesOf(lights);
    return {bytes.begin(), bytes.end()};
}

void GpuScene::placeMeshes(const DrawScene& scene, const View& view) {
    const glm::vec2 low((view.region.origin - view.canvas.origin) * view.split.raster);
    cullView_ = {{}, low, low + glm::vec2(view.region.size * view.split.raster), view.orthographic};
    // Clip space spans the canvas: −1 … 1 become its fine pixels.
    const glm::dvec2 half = 0.5 * glm::dvec2(view.canvas.size * view.split.raster);
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
        const auto& place = places_[static_cast<std::size_t>(meshOf_[i])];
        const auto [linear, pivot] = placementOf(scene.instances[i], place.pivot, view);
        glm::dmat4 viewFromMesh(linear);
        viewFromMesh[3] = glm::dvec4(pivot, 1);
        PlacedMesh mesh{clusters_[static_cast<std::size_t>(meshOf_[i])], place.firstVertex,
            3 * std::size_t{place.firstTriangle}, glm::mat4(pixelFromView * viewFromMesh),
            glm::mat4(absolute(pixelFromView) * absolute(viewFromMesh)), {}};
        // The eye is view space's origin; parallel rays come along its z axis.
        mesh.eye = glm::inverse(linear) * (view.orthographic ? glm::dvec3(0, 0, 1) : -pivot);
        cullView_.instances.push_back(mesh);
    }
}

void GpuScene::setView(const DrawScene& scene, const View& view) {
    if (!has(needs_, SceneData::positions)) return;
    if (!clusters_.empty()) placeMeshes(scene, view);
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
    if (lights_) lights_.bindUniform(kLightsBinding);
    if (atlas_) atlas_.bindSampler(atlasUnit);
}

void GpuScene::draw() const {
    vertexArray_.bind();
    gl::drawElements(commands_, static_cast<int>(materialTables_.size()));
}

void GpuScene::drawSeen(const FarthestDepths* farthest) {
    const gl::Mapping positions(positions_), indices(indices_);
    const TriangleSource source{
        reinterpret_cast<const glm::vec3*>(positions.bytes()), reinterpret_cast<const std::uint32_t*>(indices.bytes())};
    if (!farthest) parts_ = partsOf(cullView_);
    // Some at a time, so that the renderer's threads draw them while this one sets up the next and others choose those
    // after that.
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
            if (part.indices.empty()) return;
            const auto first =
                static_cast<std::int32_t>(places_[static_cast<std::size_t>(meshOf_[part.instance])].firstVertex);
            commands.push_back({static_cast<std::uint32_t>(part.indices.size()), 1,
                static_cast<std::uint32_t>(corners.size()), first, static_cast<std::uint32_t>(part.instance)});
            corners.insert(corners.end(), part.indices.begin(), part.indices.end());
            part.indices = {};
            if (corners.size() >= kCorners) drawThem();
        });
    drawThem();
}

}  // namespace limn
