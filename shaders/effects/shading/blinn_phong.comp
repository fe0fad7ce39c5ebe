// Ambient, diffuse and Blinn-Phong light; ambient occlusion dims the ambient light alone.
#include "frame/lighting.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(albedo, pixel);
    float z = load(depth, pixel).r;
    if (!isBackground(z)) {
        vec3 position = viewPosition(pixel, z);
        Material material = materialAt(load(materialId, pixel).r - 1u);
        bool own = params.exponent == 0.0;
        Lighting lit = lightingAt(pixel, position, decodeNormal(load(normal, pixel).xy), towardsEye(position), own ? material.shininess : params.exponent, vec2(params.linear, params.quadratic));
        // Highlights have the light's colour, not the object's; they cover as much as the object does.
        color.rgb = color.rgb * (lit.diffuse + params.ambient * openness(pixel, params.ao_strength)) + lit.highlight * (params.specular * (own ? material.specular : 1.0) * color.a);
    }
    write_result(color);
}
