// Depth as a light sees it. `rasterView`: the number of the map.
#include "scene/scene.glsl"

// Four texels per instance and map: columns of the matrix from the mesh to the map's clip space. They know nothing of
// the picture's camera, so that a map stays as it is while only that moves.
layout(binding = 17) uniform samplerBuffer shadowPlaces;

layout(location = 0) in vec3 meshPoint;
layout(location = 1) in uint instance;

uniform int rasterView;

#ifdef CUTOUTS
out vec3 pointInMesh;
flat out uint instanceNumber;
#endif

void main() {
    int at = (int(instance) * MAP_COUNT + rasterView) * 4;
    gl_Position = texelFetch(shadowPlaces, at) * meshPoint.x + texelFetch(shadowPlaces, at + 1) * meshPoint.y
        + texelFetch(shadowPlaces, at + 2) * meshPoint.z + texelFetch(shadowPlaces, at + 3);
#ifdef CUTOUTS
    pointInMesh = meshPoint;
    instanceNumber = instance;
#endif
}
