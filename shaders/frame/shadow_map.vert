// Depth as a light sees it. `drawing` = 8 · light + face.
#include "frame/scene.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

uniform int drawing;

void main() {
    vec3 position = vec3(instances[instance].viewFromMesh * dvec4(meshPoint, 1.0));
    gl_Position = lights[drawing / 8].shadowFromView[drawing % 8] * vec4(position, 1.0);
}
