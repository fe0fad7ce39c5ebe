// Outlines of chosen objects. They lie where the objects' mask changes between neighbouring pixels, that is, where its
// Laplacian is not 0 (the outlines of the paper on depth tangents).
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/lines.glsl"
#include "lib/steps.glsl"

struct Surface {
    float depth;
    vec3 position, face;
    uint label;  // outlines separate labels: 0 or 1 where objects are chosen, else the object's number
};

#ifdef CHOSEN
bool isIn(uint number, uint firstWord) {
    uint word = firstWord + number / 32u;
    return ((params.chosen[word / 4u][word % 4u] >> (number % 32u)) & 1u) != 0u;
}
#endif

Surface surfaceAt(ivec2 pixel) {
    Surface s;
    s.depth = load(depth, pixel).r;
    s.position = viewPosition(pixel, isBackground(s.depth) ? 0.0 : s.depth);
    s.face = decodeNormal(load(normalGeometric, pixel).xy);
    s.label = load(objectId, pixel).r;
#ifdef CHOSEN
    bool chosen = isIn(s.label, 0u);
#ifdef CHOSEN_MATERIALS
    chosen = chosen || isIn(load(materialId, pixel).r, uint(params.firstMaterialWord));
#endif
    s.label = uint(chosen);
#endif
    return s;
}

Side sideBetween(Surface a, Surface b) {
    bool emptyA = isBackground(a.depth), emptyB = isBackground(b.depth);
    bool ends = emptyA != emptyB
        || isStepBetween(a.position, a.face, b.position, b.face, pixelFootprint(min(a.depth, b.depth)), 0.05);
    // A line belongs to the chosen object; without a choice to the nearer one.
#ifdef CHOSEN
    bool ownedByB = b.label == 1u;
#else
    bool ownedByB = b.depth < a.depth;
#endif
    return Side(a.label != b.label ? OBJECT : NO_SOURCE, ownedByB, ends);
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    Surface here = surfaceAt(pixel);
    Side right = sideBetween(here, surfaceAt(min(pixel + ivec2(1, 0), view.size - 1))),
         above = sideBetween(here, surfaceAt(min(pixel + ivec2(0, 1), view.size - 1)));
    write_result(uvec4(encodeSides(right, above), 0u, 0u, 0u));
}
