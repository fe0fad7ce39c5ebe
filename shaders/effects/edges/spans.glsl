// The reach of triangles between the centres of two pixels: it places an outline to a fraction of a pixel.
//
// Include after a sampler `visibility` is declared. Homogeneous screen coordinates count from the first pixel's centre.
// They stay exact for triangles of any size and for those that reach behind the eye.

#include "lib/seen.glsl"

uvec2 seenAt(ivec2 pixel) {
    return decodeSeen(load(
        visibility, (clamp(pixel, ivec2(0), view.size - 1) + view.placeInCanvas) * view.raster + view.placeOnRaster));
}

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// The visible triangle at a pixel: its instance's number, and its corners in mesh space.
struct Triangle {
    uint number;
    vec3 corners[3];
};

Triangle triangleOf(uvec2 seen) {
    uint number = seen.x - 1u;
    Instance instance = instanceAt(number);
    ivec3 at = int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + seen.y)).xyz);
    return Triangle(number,
        vec3[3](texelFetch(positions, at.x).xyz, texelFetch(positions, at.y).xyz, texelFetch(positions, at.z).xyz));
}

// Edge functions of a triangle, linear along the way from a pixel: at + slope · t, all of one sign inside. Divided by
// their sum they are the barycentric weights of the opposite corners.
struct EdgeFunctions {
    vec3 at, slope;
};

EdgeFunctions edgesOf(Triangle triangle, ivec2 pixel, ivec2 way) {
    vec2 centre = rayOf(pixel), along = vec2(way) * view.rayScale;
    vec3 h[3];  // xy: from the pixel's centre, times z
    for (int i = 0; i < 3; ++i) {
        vec3 p = viewFromMesh(triangle.number, triangle.corners[i]);
        float w = ORTHOGRAPHIC ? 1.0 : -p.z;
        h[i] = vec3(p.xy - centre * w, w);
    }
    EdgeFunctions edges;
    for (int i = 0; i < 3; ++i) {
        vec3 a = h[(i + 1) % 3], b = h[(i + 2) % 3];
        edges.at[i] = cross2(a.xy, b.xy);
        edges.slope[i] = -(a.z * cross2(along, b.xy) + b.z * cross2(a.xy, along));
    }
    return edges;
}

// The part of the way from `pixel` to `pixel + way` that a triangle covers: from x to y, in ways; empty where x > y.
vec2 spanOf(Triangle triangle, ivec2 pixel, ivec2 way) {
    EdgeFunctions edges = edgesOf(triangle, pixel, way);
    vec3 at = edges.at, slope = edges.slope;
    float side = at.x + at.y + at.z < 0.0 ? -1.0 : 1.0;
    vec2 span = vec2(-1e9, 1e9);
    for (int i = 0; i < 3; ++i) {
        float start = side * at[i], change = side * slope[i];
        if (change > 0.0)
            span.x = max(span.x, -start / change);
        else if (change < 0.0)
            span.y = min(span.y, -start / change);
        else if (start < 0.0)
            span.y = -1e9;
    }
    return span;
}

uint objectSeen(uvec2 seen) { return triangleObject(instanceAt(seen.x - 1u), seen.y); }

// Do two triangles of an instance share two corners? It compares places, since some triangles have copies of corners.
bool shareEdge(Triangle one, Triangle other) {
    int alike = 0;
    for (int i = 0; i < 3; ++i) {
        vec3 p = other.corners[i];
        alike += int(p == one.corners[0] || p == one.corners[1] || p == one.corners[2]);
    }
    return alike >= 2;
}

#ifdef CUTOUTS
// The place on the way to a pixel where a hole begins in the triangle: 0 … 1, or 2 if none does.
float holeOnWay(uvec2 seen, ivec2 pixel, ivec2 way) {
    Instance instance = instanceAt(seen.x - 1u);
    Material look = materialAt(triangleMaterial(instance, seen.y));
    Triangle triangle = triangleOf(seen);
    EdgeFunctions edges = edgesOf(triangle, pixel, way);
    vec3 here = edges.at, there = edges.at + edges.slope, beside = edges.at + edgesOf(triangle, pixel, way.yx).slope;
    vec3 sums = vec3(here.x + here.y + here.z, there.x + there.y + there.z, beside.x + beside.y + beside.z);
    // If the triangle's plane is edge-on, or passes the eye, there is no place on it.
    if (sums.x * sums.y <= 0.0 || sums.x * sums.z <= 0.0) return 2.0;
    here /= sums.x, there /= sums.y, beside /= sums.z;
    bool staysOn = min(there.x, min(there.y, there.z)) > -0.01;
    ivec3 corners = uvCorners(instance, seen.y);
    vec2 from = uvAt(corners, here.yz), to = uvAt(corners, there.yz), aside = uvAt(corners, beside.yz);
    vec2 uvX = (to - from) / float(view.raster), uvY = (aside - from) / float(view.raster);
    float alphaHere = sampleTexture(look, from, uvX, uvY).a, alphaThere = sampleTexture(look, to, uvX, uvY).a;
    // Alpha is bilinear between texels, and so nearly linear over less than one texel.
    if (!look.hasHoles || !staysOn || alphaThere >= 0.5) return 2.0;
    return clamp((alphaHere - 0.5) / max(alphaHere - alphaThere, 1e-6), 0.0, 1.0);
}
#endif

// The visible triangles beside the way's ends: on both sides of its begin, then of its end.
uvec2 seenBeside(ivec2 pixel, ivec2 way, int i) {
    return seenAt(pixel + (i < 2 ? ivec2(0) : way) + (i % 2 == 0 ? way.yx : -way.yx));
}

// The reach, 0 … 1, of the surface visible at `pixel` towards `pixel + way`, where another is visible.
//
// The triangle visible at the pixel ends where the object ends, or where its next triangle begins. The next one need
// not be visible at any pixel's centre. It may be the other half of the same polygon, whose number is the next or the
// previous one; else it is visible close by, if anywhere. Without `goOn` the triangle's own end counts.
float reachOf(ivec2 pixel, ivec2 way, bool goOn) {
    uvec2 seen = seenAt(pixel);
    Triangle first = triangleOf(seen), end = first;
    vec2 last = spanOf(first, pixel, way);
    float reach = clamp(last.y, 0.0, 1.0);
#ifdef CUTOUTS
    float hole = holeOnWay(seen, pixel, way);
    if (hole <= 1.0) return hole;
#endif
    if (!goOn) return reach;
    // Candidates, in order: the triangle before it, the one after it, then those visible beside the way's ends.
    uint candidates = uint(seen.y > 0u) | (uint(seen.y + 1u < triangleCountOf(seen.x - 1u)) << 1);
    for (int i = 0; i < 4; ++i) {
        uvec2 other = seenBeside(pixel, way, i);
        if (other.x == seen.x && other.y != seen.y && objectSeen(other) == objectSeen(seen)) candidates |= 4u << i;
    }
    // Loops only as often as one of the pixels drawn together needs.
    do {
        int i = max(findLSB(candidates), 0);
        bool isNumbered = i < 2;
        uvec2 other = seenBeside(pixel, way, max(i - 2, 0));
        if (isNumbered) other = uvec2(seen.x, i == 0 ? seen.y - 1u : seen.y + 1u);
        Triangle next = triangleOf(candidates == 0u ? seen : other);
        vec2 span = spanOf(next, pixel, way);
        // Neighbours share an edge: one begins where the other ends, except for rounding.
        bool goesOn = reach < 1.0 && candidates != 0u && span.x <= reach + 0.01 && span.y > reach
            && (!isNumbered || shareEdge(first, next));
        if (goesOn) last = span, end = next, reach = min(span.y, 1.0);
        candidates = reach < 1.0 ? candidates & (candidates - 1u) : 0u;
    } while (candidates != 0u);
    // More invisible triangles may follow one smaller than a pixel: the object ends anywhere on the rest of the way.
    // (Not so beyond a nearly edge-on face, which is thin but long.)
    vec2 beside = spanOf(end, pixel + ivec2(round(clamp(0.5 * (last.x + last.y), 0.0, 1.0) * vec2(way))), way.yx);
    if (last.y - last.x < 0.75 && beside.y - beside.x < 1.5) reach = 0.5 * (reach + 1.0);
    return reach;
}
