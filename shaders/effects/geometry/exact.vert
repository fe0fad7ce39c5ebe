// Visibility: where the triangles are, on the grid of the whole picture.
#include "frame/scene.glsl"
#include "lib/snap.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

flat out uint instanceNumber;

void main() {
    gl_Position = snapToGrid(view.clipFromView * vec4(viewFromMesh(instance, meshPoint), 1.0));
    instanceNumber = instance + 1u;
}
