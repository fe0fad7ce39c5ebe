// The scene's data, as uploaded by src/frame/gpu_scene.cpp. Structs mirror the ones there (std430).

struct Instance {
    dmat4 viewFromMesh;         // mesh units relative to the mesh's pivot → normalized view space
    mat4 viewNormalFromMesh;    // its inverse transpose; length means nothing
    uint firstVertex;           // of the mesh, in positions, normals and uvs
    uint firstIndex;            // of the mesh, in indices
    uint materialTable;         // words[materialTable + i] = material of the mesh's i-th material name
    uint firstObject;           // object_id of the mesh's first part
    uint materialWords;         // words[materialWords + triangle] = number of its material name; NO_WORDS: all 0
    uint partWords;             // words[partWords + triangle] = number of its part; NO_WORDS: all 0
    float facing;               // -1 where the transform mirrors
    uint padding;
};

struct Material {
    vec4 color;                 // linear Rec.709
    float shininess;            // Blinn-Phong exponent; no highlight at 1 or below
    float specular;             // strength of the highlight
    int levels;                 // of the texture's mip chain; 0 = no texture
    int layer;                  // of the atlas
    ivec4 place;                // xy: level 0 in the atlas; zw: its size, in texels
};

struct Light {
    vec4 direction;             // xyz: towards the light, view space, unit; w: 0 sun, 1 point, 2 spot
    vec4 position;              // xyz: normalized view space; w: 1 / distance of half strength, or 0
    vec4 color;                 // linear, times intensity
    vec4 cone;                  // x: cosine at the cone's edge; y: where it begins to fade
    vec4 shadow;                // x: a texel's width (at unit distance, but for the sun); y: softness in texels; z: unused; w: 1 = has a map
    vec4 shadowPlace[6];        // xy: the map's origin in the shadow texture; z: its side, in texels
    mat4 shadowFromView[6];     // clip space of the map: one, or the six faces +x -x +y -y +z -z
};

const uint NO_WORDS = 0xffffffffu;

layout(std430, binding = 0) readonly buffer Positions { float positions[]; };   // three per vertex
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };
layout(std430, binding = 2) readonly buffer Normals { float normals[]; };       // three per vertex
layout(std430, binding = 3) readonly buffer Uvs { float uvs[]; };               // two per vertex
layout(std430, binding = 4) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 5) readonly buffer Words { uint words[]; };
layout(std430, binding = 6) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 7) readonly buffer Lights { Light lights[]; };

vec3 meshPosition(uint vertex) { return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]); }
vec3 meshNormal(uint vertex) { return vec3(normals[3u * vertex], normals[3u * vertex + 1u], normals[3u * vertex + 2u]); }
vec2 meshUv(uint vertex) { return vec2(uvs[2u * vertex], uvs[2u * vertex + 1u]); }

uint triangleMaterial(uint instance, uint triangle) {
    uint at = instances[instance].materialWords;
    uint local = at == NO_WORDS ? 0u : words[at + triangle];
    return words[instances[instance].materialTable + local];
}

uint triangleObject(uint instance, uint triangle) {
    uint at = instances[instance].partWords;
    return instances[instance].firstObject + (at == NO_WORDS ? 0u : words[at + triangle]);
}
