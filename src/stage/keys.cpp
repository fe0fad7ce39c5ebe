#include "stage/keys.h"

namespace limn {
namespace {

void addColor(KeyBuilder& key, const Color& color) { key.add(color.r).add(color.g).add(color.b); }

void addOptional(KeyBuilder& key, const OptionalColor& color) {
    key.add(color.given);
    addColor(key, color.color);
}

void addVector(KeyBuilder& key, const glm::dvec3& v) { key.add(v.x).add(v.y).add(v.z); }

}  // namespace

// Structured bindings name every member: a new member that is forgotten here does not compile.

ContentKey materialKey(const Material& material, const ImageKeys& images) {
    const auto& [name, color, texture, cutout, scale, offset, repeats, filter, vertexColors, shininess, specular, lines,
        lineColor, creaseAngle, isCut, hatch, cut] = material;  // what `cut` says is in the cut faces' own materials
    const auto& [spacing, width, angle, hatchColor] = hatch;
    KeyBuilder key;
    key.add(name);
    addColor(key, color);
    for (const auto& file : {texture, cutout}) {
        // The content counts, not its place: a project is the same in every folder. A file that cannot be read counts
        // by name.
        if (const auto known = images.find(file); known != images.end())
            key.add(known->second.low).add(known->second.high);
        else
            key.add(file);
    }
    key.add(scale.x).add(scale.y).add(offset.x).add(offset.y).add(repeats).add(filter);
    key.add(vertexColors).add(shininess).add(specular).add(lines);
    addOptional(key, lineColor);
    key.add(creaseAngle).add(isCut).add(spacing).add(width).add(angle);
    addColor(key, hatchColor);
    return key.key();
}

ContentKey textureKey(const Material& material, const ImageKeys& images) {
    if (material.texture.empty() && material.cutout.empty()) return {};
    KeyBuilder key;
    for (const auto& file : {material.texture, material.cutout}) {
        const auto known = images.find(file);
        key.add(file.empty());
        if (known != images.end()) key.add(known->second.low).add(known->second.high);
    }
    return key.key();
}

ContentKey lightKey(const Light& light) {
    const auto& [name, parent, kind, direction, position, color, intensity, range, angle, blend, shadow] = light;
    const auto& [present, resolution, softness] = shadow;
    KeyBuilder key;
    key.add(name).add(parent).add(kind);
    addVector(key, direction);
    addVector(key, position);
    addColor(key, color);
    key.add(intensity).add(range).add(angle).add(blend).add(present).add(resolution).add(softness);
    return key.key();
}

void addSubdivision(KeyBuilder& key, const SubdivisionOptions& options) {
    const auto& [scheme, level, limit, boundary, uv, chaikin, smoothTriangles, safe, edgeRate] = options;
    key.add(scheme).add(level).add(limit).add(boundary).add(uv).add(chaikin).add(smoothTriangles).add(safe);
    key.add(static_cast<bool>(edgeRate));
}

}  // namespace limn
