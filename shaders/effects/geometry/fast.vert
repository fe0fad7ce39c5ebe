// The classic G-buffer: attributes go through the hardware's interpolators.
#include "frame/scene.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;
#ifdef WRITES_normal
layout(location = 2) in vec3 meshNormalIn;
out vec3 viewNormal;
#endif
#if defined(WRITES_albedo) && defined(TEXTURED)
layout(location = 3) in vec2 meshUvIn;
out vec2 textureUv;
#endif

flat out uint instanceNumber;
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
out vec3 viewPoint;
#endif

void main() {
    vec3 point = vec3(instances[instance].viewFromMesh * dvec4(meshPoint, 1.0));
    gl_Position = view.clipFromView * vec4(point, 1.0);
    instanceNumber = instance;
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
    viewPoint = point;
#endif
#ifdef WRITES_normal
    viewNormal = mat3(instances[instance].viewNormalFromMesh) * meshNormalIn;
#endif
#if defined(WRITES_albedo) && defined(TEXTURED)
    textureUv = meshUvIn;
#endif
}
