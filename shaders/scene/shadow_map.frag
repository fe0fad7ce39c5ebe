// Only the depth buffer is wanted.
#ifdef CUTOUTS
#include "scene/scene.glsl"
#include "scene/holes.glsl"
in vec3 pointInMesh;
flat in uint instanceNumber;

void main() {
    if (isHole(instanceNumber, uint(gl_PrimitiveID), pointInMesh)) discard;
}
#else

void main() {}
#endif
