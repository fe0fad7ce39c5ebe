// The intensity that toon shading quantizes: (sum of max(0, N·L)·shadow + ambient)·ao + extra ambient + highlights.
//
// Writes it in the red channel; with coloured lights the colour of the light, scaled to a largest channel of 1, in rgb and the intensity
// in alpha.
#include "frame/scene.glsl"
#include "frame/lights.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#ifdef WITH_SHADOWS
#include "lib/shadow.glsl"
#endif

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float z = texelFetch(depth, pixel, 0).r;
    if (isBackground(z)) {
        write_result(vec4(0));
        return;
    }
    vec3 position = viewPosition(pixel, z);
    vec3 n = decodeNormal(texelFetch(normal, pixel, 0).xy);
    Material material = materialAt(texelFetch(materialId, pixel, 0).r - 1u);
    vec3 eye = params.trueViewDirection ? towardsEye(position) : vec3(0, 0, 1);

    vec3 diffuse = vec3(0), highlight = vec3(0);
    for (int i = 0; i < LIGHT_COUNT; ++i) {
        vec3 towards = lights[i].direction.xyz;
        float strength = 1.0;
        if (lights[i].direction.w > 0.0) {   // point or spot
            vec3 path = lights[i].position.xyz - position;
            float range = length(path);
            vec3 along = path / max(range, 1e-9);
            float halves = range * lights[i].position.w;
            strength = 1.0 / (1.0 + halves * halves);
            if (lights[i].direction.w == 2.0) strength *= smoothstep(lights[i].cone.x, lights[i].cone.y, dot(along, towards));
            towards = along;
        }
        float facing = dot(n, towards);
#ifdef WITH_SHADOWS
        if (lights[i].shadow.w > 0.0) strength *= shadowOf(lights[i], position, decodeNormal(texelFetch(normalGeometric, pixel, 0).xy), towards);
#endif
        diffuse += lights[i].color.rgb * (strength * max(facing, 0.0));
        if (material.shininess > 1.0 && facing > 0.0) {
            // Opposite directions leave no half vector; there is no highlight then either.
            vec3 between = towards + eye;
            float size = length(between);
            float cosine = size > 1e-6 ? max(dot(n, between) / size, 0.0) : 0.0;
            highlight += lights[i].color.rgb * (strength * material.specular * params.specular * pow(cosine, material.shininess));
        }
    }
    float open = 1.0;
#ifdef WITH_AO
    open = mix(1.0, texelFetch(ambientOcclusion, pixel, 0).r, params.aoStrength);
#endif
    vec3 light = (diffuse + params.ambient) * open + params.extraAmbient + highlight;
#ifdef COLORED_LIGHT
    float intensity = max(light.r, max(light.g, light.b));
    write_result(vec4(intensity > 0.0 ? light / intensity : vec3(1), intensity));
#else
    write_result(vec4(light.r));
#endif
}
