// Writes only the visible triangle; exact.comp evaluates everything else, once per visible pixel.
#include "lib/seen.glsl"
#ifdef CUTOUTS
#include "scene/scene.glsl"
#include "scene/holes.glsl"
in vec3 pointInMesh;
#endif

flat in uvec2 seen;

void main() {
#ifdef CUTOUTS
    if (isHole(seen.x - 1u, seen.y, pointInMesh)) discard;
#endif
    visibility = encodeSeen(seen);
}
