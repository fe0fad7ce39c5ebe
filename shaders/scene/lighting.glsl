// Light that reaches a surface; shading techniques quantize, sum or attenuate it. For passes that called
// readLighting().
#include "scene/scene.glsl"
#include "scene/lights.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#ifdef WITH_SHADOWS
#include "lib/shadow.glsl"
#endif

struct Lighting {
    vec3 diffuse, highlight;
};

// Diffuse light max(0, N·L) and, with HIGHLIGHTS, Blinn-Phong highlights max(0, N·H)^shininess, times each light's
// colour, range, cone and shadow. PLACED_LIGHTS: some light is a point or spot; SPOTS: some is a spot. `attenuation`:
// linear and quadratic factors of 1/(1 + l·d + q·d²) for lights with a place, d in scene units. `eye`: unit, towards
// the viewer.
Lighting lightingAt(ivec2 pixel, vec3 position, vec3 n, vec3 eye, float shininess, vec2 attenuation) {
    Lighting sum = Lighting(vec3(0), vec3(0));
    for (int i = 0; i < LIGHT_COUNT; ++i) {
        vec3 towards = lightDirection(i);
        float strength = 1.0;
#ifdef PLACED_LIGHTS
        if (lights[i].direction.w > 0.0) {  // point or spot
            vec3 path = lights[i].position.xyz - position;
            float range = length(path);
            vec3 along = path / max(range, 1e-9);
            float halves = range * lights[i].position.w, d = range / view.unit;
            strength = 1.0 / (1.0 + halves * halves);
            strength /= 1.0 + attenuation.x * d + attenuation.y * d * d;
#ifdef SPOTS
            if (lights[i].direction.w == 2.0)
                strength *= smoothstep(lights[i].cone.x, lights[i].cone.y, dot(along, towards));
#endif
            towards = along;
        }
#endif
        float facing = dot(n, towards);
#ifdef WITH_SHADOWS
        if (lights[i].shadow.w > 0.0)
            strength *= shadowOf(lights[i], position, decodeNormal(load(normalGeometric, pixel).xy), towards);
#endif
        sum.diffuse += lightColor(i) * (strength * max(facing, 0.0));
#ifdef HIGHLIGHTS
        if (shininess > 1.0 && facing > 0.0) {
            // Opposite directions have no half vector, and then there is no highlight.
            vec3 between = towards + eye;
            float size = length(between);
            float cosine = size > 1e-6 ? max(dot(n, between) / size, 0.0) : 0.0;
            sum.highlight += lightColor(i) * (strength * pow(cosine, shininess));
        }
#endif
    }
    return sum;
}

// Exponent (x) and strength (y) of the highlights on a pixel's surface.
vec2 highlightsOf(ivec2 pixel) {
#ifdef SHINY_MATERIALS
    Material material = materialAt(load(materialId, pixel).r - 1u);
    return vec2(material.shininess, material.specular);
#else
    return vec2(0);
#endif
}

// The pixel's openness, 1 where nothing computes it.
float openness(ivec2 pixel, float strength) {
#ifdef WITH_AO
    return mix(1.0, load(ambientOcclusion, pixel).r, strength);
#else
    return 1.0;
#endif
}
