// Shadow maps, all in one depth texture, with depth reversed (nearer to the light = larger).

// The unshadowed part (0 … 1) of a light at a position in normalized view space. The position is moved off its surface
// by a texel or two, farther the steeper the surface is to the light: so a surface does not shadow itself, and shadows
// do not lift off.
float shadowOf(Light light, vec3 position, vec3 normal, vec3 towardsLight) {
    vec3 fromLight = light.direction.w == 0.0 ? vec3(0) : position - light.position.xyz;
    float texel = light.shadow.x * (light.direction.w == 0.0 ? 1.0 : max(length(fromLight), 1e-6));
    float slope = sqrt(max(0.0, 1.0 - dot(normal, towardsLight) * dot(normal, towardsLight)));
    float reach = 1.0 + max(light.shadow.y, 1.0);
    vec3 lifted = position + normal * texel * (0.4 + slope) * reach;

    int face = 0;
#ifdef POINT_SHADOWS
    if (light.direction.w == 1.0) {
        // Faces are aligned with the world's axes.
        vec3 d = mat3(view.worldFromView) * (lifted - light.position.xyz);
        vec3 a = abs(d);
        face = a.x >= a.y && a.x >= a.z ? (d.x > 0.0 ? 0 : 1) : a.y >= a.z ? (d.y > 0.0 ? 2 : 3) : (d.z > 0.0 ? 4 : 5);
    }
#endif
    vec4 clip = light.shadowFromView[face] * vec4(lifted, 1.0);
    if (clip.w <= 0.0) return 1.0;
    vec3 ndc = clip.xyz / clip.w;
    float side = light.shadowPlace[face].z;
    vec2 at = (ndc.xy * 0.5 + 0.5) * side;
    if (any(lessThan(at, vec2(0))) || any(greaterThanEqual(at, vec2(side))) || ndc.z <= 0.0) return 1.0;

    // A tent of the wanted width, over the texels whose centres lie under it.
    float width = max(light.shadow.y, 0.5) + 0.5;
    ivec2 first = ivec2(ceil(at - width - 0.5));
    int count = int(ceil(2.0 * width));
    float lit = 0.0, total = 0.0;
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
            ivec2 texelAt = first + ivec2(x, y);
            vec2 distance = abs(vec2(texelAt) + 0.5 - at);
            float weight = max(0.0, width - distance.x) * max(0.0, width - distance.y);
            ivec2 inside = clamp(texelAt, ivec2(0), ivec2(side) - 1);
            lit += texelFetch(shadowMaps, ivec2(light.shadowPlace[face].xy) + inside, 0).r > ndc.z ? 0.0 : weight;
            total += weight;
        }
    return total > 0.0 ? lit / total : 1.0;
}
