// The lights, in view space. Mirrors src/gpu/lights.cpp (std140). Passes that include this define LIGHT_COUNT.

struct Light {
    vec4 direction;  // xyz: towards the light, view space, unit; w: 0 sun, 1 point, 2 spot
    vec4 position;   // xyz: normalized view space; w: 1 / distance of half strength, or 0
    vec4 color;      // linear, times intensity
    vec4 cone;       // x: cosine at the cone's edge; y: where it begins to fade
    vec4 shadow;     // x: a texel's width (at unit distance, but for the sun); y: softness in texels; w: 1 = has a map
    vec4 shadowPlace[6];     // xy: the map's origin in the shadow texture; z: its side, in texels
    mat4 shadowFromView[6];  // clip space of the map: one, or the six faces +x -x +y -y +z -z
};

layout(std140, binding = 2) uniform Lights { Light lights[LIGHT_COUNT]; };

// Data of every light. SUNS_HANDED_ON: the vertex shader has handed it on, see gpu/hand_on_suns.glsl.
#ifdef SUNS_HANDED_ON
flat in vec4 sunDirection[LIGHT_COUNT], sunColor[LIGHT_COUNT];
vec3 lightDirection(int light) { return sunDirection[light].xyz; }
vec3 lightColor(int light) { return sunColor[light].rgb; }
#else
vec3 lightDirection(int light) { return lights[light].direction.xyz; }
vec3 lightColor(int light) { return lights[light].color.rgb; }
#endif
