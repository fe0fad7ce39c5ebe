// For vertex shaders that hand suns without shadows on to fragment shaders; see scene/lights.glsl.
#include "scene/lights.glsl"

flat out vec4 sunDirection[LIGHT_COUNT], sunColor[LIGHT_COUNT];

void handOnSuns() {
    for (int i = 0; i < LIGHT_COUNT; ++i) sunDirection[i] = lights[i].direction, sunColor[i] = lights[i].color;
}
