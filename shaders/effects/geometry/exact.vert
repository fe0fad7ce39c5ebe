// Visibility: where the triangles are. Positions are transformed in double precision, since a large mesh close to the eye loses every
// digit in float, and snapped to the grid of the whole picture.
#include "frame/scene.glsl"
#include "lib/snap.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

flat out uint instanceNumber;

void main() {
    vec3 position = vec3(instances[instance].viewFromMesh * dvec4(meshPoint, 1.0));
    gl_Position = snapToGrid(view.clipFromView * vec4(position, 1.0));
    instanceNumber = instance + 1u;
}
