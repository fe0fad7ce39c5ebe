// Visibility: the places of triangles, on the grid of the whole picture.
#include "scene/scene.glsl"
#include "lib/snap.glsl"

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

// Instance, counted from 1, and triangle. The provoking vertex, the last one, brings both: see numberByLastVertex in
// tri_mesh.h.
flat out uvec2 seen;
#ifdef CUTOUTS
out vec3 pointInMesh;
#endif

void main() {
    gl_Position = snapToGrid(view.clipFromView * vec4(viewFromMesh(instance, meshPoint), 1.0));
#ifdef CUTOUTS
    pointInMesh = meshPoint;
#endif
    seen = uvec2(instance + 1u, uint(gl_VertexID) - firstVertexOf(instance));
}
