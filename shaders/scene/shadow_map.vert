// Depth as a light sees it. `rasterView` = 8 · light + face.
#include "scene/scene.glsl"
#include "scene/lights.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

uniform int rasterView;

#ifdef CUTOUTS
out vec3 viewPoint;
flat out uint instanceNumber;
#endif

void main() {
    vec3 point = viewFromMesh(instance, meshPoint);
    gl_Position = lights[rasterView / 8].shadowFromView[rasterView % 8] * vec4(point, 1.0);
#ifdef CUTOUTS
    viewPoint = point;
    instanceNumber = instance;
#endif
}
