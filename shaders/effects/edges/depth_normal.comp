// Finds the lines between a pixel and its neighbours at the right and above: where surfaces end, bend, or change object
// or material.
#include "scene/scene.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/lines.glsl"
#include "lib/steps.glsl"

// The compared data of a pixel.
struct Surface {
    float depth;
    vec3 normal;          // for shading
    vec3 position, face;  // view space; face: normal of the triangle
    uint object, material, record;
};

Surface surfaceAt(ivec2 pixel) {
    Surface s;
    s.depth = load(depth, pixel).r;
    s.position = viewPosition(pixel, isBackground(s.depth) ? 0.0 : s.depth);
    s.face = decodeNormal(load(normalGeometric, pixel).xy);
#ifdef WITH_CREASE
    s.normal = decodeNormal(load(normal, pixel).xy);
#endif
#ifdef WITH_OBJECT
    s.object = load(objectId, pixel).r;
#endif
#if defined(WITH_MATERIAL) || defined(WITH_SECTION)
    s.material = load(materialId, pixel).r;
#endif
    s.record = 0u;
#ifdef WITH_RECORDS
    s.record = load(lineRecord, pixel).r;
#endif
    return s;
}

bool drawsLines(Surface s) {
#ifdef WITH_RECORDS
    return lineRecordAt(s.record).draws;
#else
    return true;
#endif
}

float creaseCosine(Surface s) {
#ifdef WITH_RECORDS
    LineRecord own = lineRecordAt(s.record);
    if (own.creaseCosine >= -1.0) return own.creaseCosine;
#endif
    return params.cosine;
}

#ifdef PROJECTED_DEPTH
// Standard depth: 0 at near, 1 at far.
float projected(float z) {
    if (isBackground(z)) return 1.0;
    return ORTHOGRAPHIC ? (z - params.near) / (params.far - params.near)
                        : params.far / (params.far - params.near) * (1.0 - params.near / z);
}
#endif

// One surface ends in front of the other.
bool isStep(Surface a, Surface b) {
#ifdef PROJECTED_DEPTH
    return abs(projected(b.depth) - projected(a.depth)) > params.depthThreshold * (1.0 - projected(a.depth));
#else
    return isStepBetween(a.position, a.face, b.position, b.face, pixelFootprint(min(a.depth, b.depth)), params.step);
#endif
}

// The source and the owner of a line between two surfaces, if there is one. Of several sources the last that applies
// counts. The code has no branches, since software renderers take both sides of each.
Side sideBetween(Surface a, Surface b) {
    bool emptyA = isBackground(a.depth), emptyB = isBackground(b.depth), both = !emptyA && !emptyB;
    bool outline = emptyA != emptyB || (both && isStep(a, b)), bIsNearer = b.depth < a.depth;
    bool drawsA = !emptyA && drawsLines(a), drawsB = !emptyB && drawsLines(b);
    // Where surfaces touch, a line belongs to the one that draws lines, or to the nearer if both do.
    bool ownedByB = outline ? bIsNearer : !drawsA || (drawsB && bIsNearer);
    bool drawn = outline ? (bIsNearer ? drawsB : drawsA) : drawsA || drawsB;
    uint source = NO_SOURCE;
#ifdef WITH_CREASE
    float cosine = dot(a.normal, b.normal);
    source = both && !outline && ((drawsA && cosine < creaseCosine(a)) || (drawsB && cosine < creaseCosine(b)))
        ? CREASE
        : source;
#endif
#ifdef WITH_MATERIAL
    source = both && a.material != b.material ? MATERIAL : source;
#endif
#ifdef WITH_OBJECT
    source = a.object != b.object ? OBJECT : source;
#endif
#ifdef WITH_SILHOUETTE
    source = outline ? SILHOUETTE : source;
#endif
#ifdef WITH_SECTION
    bool cutA = !emptyA && lineRecordAt(a.record).isCut, cutB = !emptyB && lineRecordAt(b.record).isCut;
    source = cutA != cutB ? SECTION : source;
    // On the cut only unlike materials are parted, whatever object they belong to.
    bool parts = a.material != b.material;
#ifdef WITH_MATERIAL
    source = cutA && cutB ? (parts ? MATERIAL : NO_SOURCE) : source;
#else
    source = cutA && cutB ? (parts ? SECTION : NO_SOURCE) : source;
#endif
    outline = outline && !(cutA && cutB);
    ownedByB = cutA != cutB ? cutB : ownedByB;
#endif
    return Side(drawn ? source : NO_SOURCE, ownedByB, outline);
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    Surface here = surfaceAt(pixel);
    Side right = sideBetween(here, surfaceAt(min(pixel + ivec2(1, 0), view.size - 1))),
         above = sideBetween(here, surfaceAt(min(pixel + ivec2(0, 1), view.size - 1)));
    write_result(uvec4(encodeSides(right, above), 0u, 0u, 0u));
}
