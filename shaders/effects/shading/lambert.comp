// Lambert's cosine law; ambient occlusion dims the ambient light alone.
#include "scene/lighting.glsl"

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    vec4 color = load(albedo, pixel);
    float z = load(depth, pixel).r;
    if (!isBackground(z)) {
        Lighting lit = lightingAt(
            pixel, viewPosition(pixel, z), decodeNormal(load(normal, pixel).xy), vec3(0, 0, 1), 0.0, vec2(0));
        color.rgb *= lit.diffuse * params.intensity + params.ambient * openness(pixel, params.ao_strength);
    }
    write_result(color);
}
