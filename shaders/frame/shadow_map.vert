// Depth as a light sees it. `drawing` = 8 · light + face.
#include "frame/scene.glsl"
#include "frame/lights.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

uniform int drawing;

void main() { gl_Position = lights[drawing / 8].shadowFromView[drawing % 8] * vec4(viewFromMesh(instance, meshPoint), 1.0); }
