// Ambient, diffuse and Blinn-Phong light; ambient occlusion dims the ambient light alone.
#include "scene/lighting.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(albedo, pixel);
    float z = load(depth, pixel).r;
    if (!isBackground(z)) {
        vec3 position = viewPosition(pixel, z);
        vec2 highlights = params.exponent == 0.0 ? highlightsOf(pixel) : vec2(params.exponent, 1.0);
        Lighting lit = lightingAt(pixel, position, decodeNormal(load(normal, pixel).xy), towardsEye(position),
            highlights.x, vec2(params.linear, params.quadratic));
        // Highlights have the light's colour, not the object's; they cover as much as the object does.
        color.rgb = color.rgb * (lit.diffuse + params.ambient * openness(pixel, params.ao_strength))
            + lit.highlight * (params.specular * highlights.y * color.a);
    }
    write_result(color);
}
