// Only the depth buffer is wanted.
#ifdef CUTOUTS
#include "scene/scene.glsl"
#include "scene/holes.glsl"
in vec3 viewPoint;
flat in uint instanceNumber;

void main() {
    if (isHole(instanceNumber, uint(gl_PrimitiveID), viewPoint)) discard;
}
#else

void main() {}
#endif
