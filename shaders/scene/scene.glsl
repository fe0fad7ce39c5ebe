// The scene's data, as uploaded by src/gpu/gpu_scene.cpp.
//
// Buffer textures, not storage buffers: a fetch brings up to four numbers at once, and software renderers read them
// several times faster.

#include "lib/color.glsl"

layout(binding = 6) uniform samplerBuffer positions;   // xyz, mesh units from the mesh's pivot
layout(binding = 7) uniform usamplerBuffer triangles;  // per triangle: its three positions, counted within the mesh
layout(binding = 8) uniform samplerBuffer normals;     // xyz
layout(binding = 9) uniform usamplerBuffer triangleNormals;  // per triangle: its three normals
layout(binding = 10) uniform samplerBuffer uvs;
layout(binding = 11) uniform usamplerBuffer triangleUvs;  // per triangle: its three uvs
// words: line records, numbers of materials and parts, vertex colours; see Instance
layout(binding = 12) uniform usamplerBuffer words;
layout(binding = 13) uniform usamplerBuffer instances;  // twelve texels per instance; see below
layout(binding = 14) uniform samplerBuffer materials;   // six texels per material

// Three texels per instance: rows of the matrix from the mesh to the previous frame's pixels, times w, and w.
layout(binding = 16) uniform samplerBuffer previousPlaces;

const int INSTANCE_TEXELS = 12;
const uint NO_WORDS = 0xffffffffu;

struct Instance {
    uint firstVertex;    // of the mesh, in positions
    uint firstTriangle;  // of the mesh, in triangles
    uint materialTable;  // words[materialTable + 2·i] = material of the mesh's i-th material name, the next word its
                         // line record
    uint firstObject;    // object_id of the mesh's first part
    uint materialWords;  // words[materialWords + triangle] = number of its material name; NO_WORDS: all 0
    uint partWords;      // words[partWords + triangle] = number of its part; NO_WORDS: all 0
    uint firstNormal;    // of the mesh, in normals
    uint firstUv;        // of the mesh, in uvs
};

// words[colorWordsOf(number) + 3·triangle + corner] = vertex colour, see unpackColor; NO_WORDS: none.
uint colorWordsOf(uint number) { return texelFetch(instances, int(number) * INSTANCE_TEXELS + 11).y; }

// Ten bits each of display-encoded red, green and blue → linear Rec.709.
vec3 unpackColor(uint packed_) {
    return srgbToLinear(vec3(uvec3(packed_, packed_ >> 10, packed_ >> 20) & 1023u) / 1023.0);
}

uint triangleCountOf(uint number) { return texelFetch(instances, int(number) * INSTANCE_TEXELS + 11).x; }

Instance instanceAt(uint number) {
    int at = int(number) * INSTANCE_TEXELS;
    uvec4 a = texelFetch(instances, at + 9), b = texelFetch(instances, at + 10);
    return Instance(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

uint firstVertexOf(uint number) { return texelFetch(instances, int(number) * INSTANCE_TEXELS + 9).x; }

// Mesh units relative to the mesh's pivot → normalized view space.
vec3 viewFromMesh(uint number, vec3 point) {
    int at = int(number) * INSTANCE_TEXELS + 6;
    vec4 p = vec4(point, 1.0);
    return vec3(dot(uintBitsToFloat(texelFetch(instances, at)), p),
        dot(uintBitsToFloat(texelFetch(instances, at + 1)), p), dot(uintBitsToFloat(texelFetch(instances, at + 2)), p));
}

// The pixel in which a point of the mesh was seen in the frame before, from the picture's lower left; `otherwise` where
// it was not in front of the camera, or not there.
vec2 previousPixel(uint number, vec3 point, vec2 otherwise) {
    int at = int(number) * 3;
    vec4 p = vec4(point, 1.0);
    float w = dot(texelFetch(previousPlaces, at + 2), p);
    vec2 pixel = vec2(dot(texelFetch(previousPlaces, at), p), dot(texelFetch(previousPlaces, at + 1), p));
    return w > 0.0 ? pixel / w : otherwise;
}

// Its inverse, in double precision: rows of a 3×4 matrix.
struct MeshFromView {
    dvec3 rows[3];
    dvec3 offset;
};

MeshFromView meshFromViewAt(uint number) {
    int at = int(number) * INSTANCE_TEXELS;
    MeshFromView m;
    for (int row = 0; row < 3; ++row) {
        uvec4 a = texelFetch(instances, at + 2 * row), b = texelFetch(instances, at + 2 * row + 1);
        m.rows[row] = dvec3(packDouble2x32(a.xy), packDouble2x32(a.zw), packDouble2x32(b.xy));
        m.offset[row] = packDouble2x32(b.zw);
    }
    return m;
}

// A normal of the mesh in view space, of any length: the inverse transpose of view-from-mesh is the transpose of
// mesh-from-view.
vec3 viewNormal(MeshFromView m, vec3 normal) {
    dvec3 n = m.rows[0] * double(normal.x) + m.rows[1] * double(normal.y) + m.rows[2] * double(normal.z);
    // Scaled into float's range before it becomes float: instances may be scaled by anything.
    return vec3(n / max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-300lf)));
}

// The uv numbers of a triangle's corners: with one index for all attributes, those of its vertices.
ivec3 uvCorners(Instance instance, uint triangle) {
#ifdef UNIFIED
    return int(instance.firstUv) + ivec3(texelFetch(triangles, int(instance.firstTriangle + triangle)).xyz);
#else
    return int(instance.firstUv) + ivec3(texelFetch(triangleUvs, int(instance.firstTriangle + triangle)).xyz);
#endif
}

// uv at a place on a triangle: barycentric weights of the second and third corner.
vec2 uvAt(ivec3 corners, vec2 weights) {
    vec2 first = texelFetch(uvs, corners.x).xy;
    return first + weights.x * (texelFetch(uvs, corners.y).xy - first)
        + weights.y * (texelFetch(uvs, corners.z).xy - first);
}

uint triangleMaterial(Instance instance, uint triangle) {
    uint local = instance.materialWords == NO_WORDS ? 0u : texelFetch(words, int(instance.materialWords + triangle)).r;
    return texelFetch(words, int(instance.materialTable + 2u * local)).r;
}

uint triangleLineRecord(Instance instance, uint triangle) {
    uint local = instance.materialWords == NO_WORDS ? 0u : texelFetch(words, int(instance.materialWords + triangle)).r;
    return texelFetch(words, int(instance.materialTable + 2u * local + 1u)).r;
}

// Line records of objects and materials: five words each, at the beginning of `words`.
struct LineRecord {
    vec3 color;                   // linear Rec.709
    float creaseCosine;           // below -1: from the line technique
    bool draws, hasColor, isCut;  // isCut: the cut face of a section
};

LineRecord lineRecordAt(uint number) {
    int at = int(number) * 5;
    uint flags = texelFetch(words, at + 4).r;
    vec4 numbers = uintBitsToFloat(uvec4(texelFetch(words, at).r, texelFetch(words, at + 1).r,
        texelFetch(words, at + 2).r, texelFetch(words, at + 3).r));
    return LineRecord(numbers.rgb, numbers.a, (flags & 1u) != 0u, (flags & 2u) != 0u, (flags & 4u) != 0u);
}

uint triangleObject(Instance instance, uint triangle) {
    return instance.firstObject
        + (instance.partWords == NO_WORDS ? 0u : texelFetch(words, int(instance.partWords + triangle)).r);
}

struct Material {
    vec3 color;       // linear Rec.709
    int levels;       // of the texture's mip chain; 0 = no texture
    float shininess;  // Blinn-Phong exponent; no highlight at 1 or below
    float specular;   // strength of the highlight
    int layer;        // of the atlas
    bool hasHoles;    // where the texture's alpha is below one half
    bool takesVertexColors;
    bool isSharp;      // the texture's texels are visible as squares
    bool repeats;      // the texture repeats beyond its borders; else these continue
    uint number;       // of the material
    ivec4 place;       // xy: level 0 in the atlas; zw: its size, in texels
    vec2 hatch;        // across hatching lines, 1 over their distance in pixels long; 0: none
    float hatchWidth;  // pixels
    vec3 hatchColor;
};

Material materialAt(uint number) {
    int at = int(number) * 6;
    vec4 a = texelFetch(materials, at), b = texelFetch(materials, at + 1), c = texelFetch(materials, at + 2),
         d = texelFetch(materials, at + 3), e = texelFetch(materials, at + 4);
    int flags = int(b.w);
    return Material(a.rgb, int(a.a), b.x, b.y, int(b.z), (flags & 1) != 0, (flags & 2) != 0, (flags & 4) != 0,
        (flags & 8) != 0, number, ivec4(c), d.xy, d.z, e.rgb);
}

// xy: factor on texture coordinates; zw: added after that.
vec4 texturePlacing(Material material) { return texelFetch(materials, int(material.number) * 6 + 5); }

// The material's colour under its hatching, at a place in the picture (pixels): lines with coverage per pixel.
vec3 hatched(Material look, vec2 place) {
    float spacings = dot(look.hatch, place), perPixel = length(look.hatch);
    float distance = abs(fract(spacings) - 0.5) / max(perPixel, 1e-9);
    float coverage =
        perPixel > 0.0 ? clamp(0.5 * look.hatchWidth - distance + 0.5, 0.0, min(1.0, look.hatchWidth)) : 0.0;
    return mix(look.color, look.hatchColor, coverage);
}
