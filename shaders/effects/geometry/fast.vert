// The classic G-buffer: attributes go through the hardware's interpolators.
#include "scene/scene.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;
#ifdef WRITES_normal
layout(location = 2) in vec3 meshNormal;
out vec3 normalBetween;
#endif
#if (defined(WRITES_albedo) && defined(TEXTURED)) || defined(CUTOUTS)
#define WITH_UVS
layout(location = 3) in vec2 meshUv;
out vec2 uvBetween;
#endif
#if defined(WRITES_albedo) && defined(VERTEX_COLORS)
out vec3 colorBetween;
#endif
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
out vec3 viewPoint;
#endif
flat out uint instanceNumber;

void main() {
    vec3 point = viewFromMesh(instance, meshPoint);
    gl_Position = view.clipFromView * vec4(point, 1.0);
    instanceNumber = instance;
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
    viewPoint = point;
#endif
#ifdef WRITES_normal
    normalBetween = viewNormal(meshFromViewAt(instance), meshNormal);
    normalBetween /= max(length(normalBetween), 1e-30);
#endif
#ifdef WITH_UVS
    uvBetween = meshUv;
#endif
#if defined(WRITES_albedo) && defined(VERTEX_COLORS)
    uint colorWords = colorWordsOf(instance);
    colorBetween = colorWords == NO_WORDS
        ? vec3(1)
        : unpackColor(texelFetch(words, int(colorWords) + gl_VertexID - int(firstVertexOf(instance))).r);
#endif
}
