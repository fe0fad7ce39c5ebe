// How far triangles reach between the centres of two pixels: where an outline runs, to a fraction of a pixel.
//
// Include after a sampler `visibility` is declared. Works on homogeneous screen coordinates counted from the first pixel's centre, which stay
// exact for triangles of any size and for those that reach behind the eye.

uvec2 seenAt(ivec2 pixel) { return load(visibility, (clamp(pixel, ivec2(0), view.size - 1) + view.placeInCanvas) * view.raster + view.placeOnRaster).xy; }

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Edge functions of a triangle, linear along the way from a pixel: at + slope · t, all of one sign inside. Divided by their sum they are the barycentric
// weights of the corners across.
struct EdgeFunctions { vec3 at, slope; };

EdgeFunctions edgesOf(uvec2 seen, ivec2 pixel, ivec2 way) {
    uint number = seen.x - 1u;
    Instance instance = instanceAt(number);
    ivec3 corners = int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + seen.y)).xyz);
    vec2 centre = rayOf(pixel), along = vec2(way) * view.rayScale;
    vec3 h[3];   // xy: from the pixel's centre, times z
    for (int i = 0; i < 3; ++i) {
        vec3 p = viewFromMesh(number, texelFetch(positions, corners[i]).xyz);
        float w = view.orthographic ? 1.0 : -p.z;
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
vec2 spanOf(uvec2 seen, ivec2 pixel, ivec2 way) {
    EdgeFunctions edges = edgesOf(seen, pixel, way);
    vec3 at = edges.at, slope = edges.slope;
    float side = at.x + at.y + at.z < 0.0 ? -1.0 : 1.0;
    vec2 span = vec2(-1e9, 1e9);
    for (int i = 0; i < 3; ++i) {
        float start = side * at[i], change = side * slope[i];
        if (change > 0.0) span.x = max(span.x, -start / change);
        else if (change < 0.0) span.y = min(span.y, -start / change);
        else if (start < 0.0) span.y = -1e9;
    }
    return span;
}

uint objectSeen(uvec2 seen) { return triangleObject(instanceAt(seen.x - 1u), seen.y); }

// Do two triangles of an instance have two corners in common? Corners are stored anew for some triangles: places decide.
bool shareEdge(uint number, uint one, uint other) {
    Instance instance = instanceAt(number);
    ivec3 a = int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + one)).xyz), b = int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + other)).xyz);
    vec3 a0 = texelFetch(positions, a.x).xyz, a1 = texelFetch(positions, a.y).xyz, a2 = texelFetch(positions, a.z).xyz;
    int alike = 0;
    for (int i = 0; i < 3; ++i) {
        vec3 p = texelFetch(positions, b[i]).xyz;
        alike += int(p == a0 || p == a1 || p == a2);
    }
    return alike >= 2;
}

#ifdef CUTOUTS
// Where on the way to a pixel a hole begins in the triangle: 0 … 1, and 2 where none does.
float holeOnWay(uvec2 seen, ivec2 pixel, ivec2 way) {
    Instance instance = instanceAt(seen.x - 1u);
    Material look = materialAt(triangleMaterial(instance, seen.y));
    EdgeFunctions edges = edgesOf(seen, pixel, way);
    vec3 here = edges.at, there = edges.at + edges.slope, beside = edges.at + edgesOf(seen, pixel, way.yx).slope;
    vec3 sums = vec3(here.x + here.y + here.z, there.x + there.y + there.z, beside.x + beside.y + beside.z);
    // Where the triangle's plane is seen edge-on, or passes the eye, there is no place on it.
    if (sums.x * sums.y <= 0.0 || sums.x * sums.z <= 0.0) return 2.0;
    here /= sums.x, there /= sums.y, beside /= sums.z;
    bool staysOn = min(there.x, min(there.y, there.z)) > -0.01;
    ivec3 corners = uvCorners(instance, seen.y);
    vec2 from = uvAt(corners, here.yz), to = uvAt(corners, there.yz), aside = uvAt(corners, beside.yz);
    vec2 uvX = (to - from) / float(view.raster), uvY = (aside - from) / float(view.raster);
    float alphaHere = sampleTexture(look, from, uvX, uvY).a, alphaThere = sampleTexture(look, to, uvX, uvY).a;
    // Alpha is bilinear between texels: as good as straight over less than one of them.
    if (!look.hasHoles || !staysOn || alphaThere >= 0.5) return 2.0;
    return clamp((alphaHere - 0.5) / max(alphaHere - alphaThere, 1e-6), 0.0, 1.0);
}
#endif

// How far what is seen at `pixel` reaches towards `pixel + way`, where something else is seen: 0 … 1.
//
// The triangle seen at the pixel ends where the object ends, or where its next triangle begins. That one need not be seen at any pixel's centre:
// it may be the other half of the same polygon, which has the next number or the one before; else it is seen close by, if anywhere. Without `goOn` the triangle's own end counts.
float reachOf(ivec2 pixel, ivec2 way, bool goOn) {
    uvec2 seen = seenAt(pixel);
    uvec2 lastSeen = seen;
    vec2 last = spanOf(seen, pixel, way);
    float reach = clamp(last.y, 0.0, 1.0);
#ifdef CUTOUTS
    float hole = holeOnWay(seen, pixel, way);
    if (hole <= 1.0) return hole;
#endif
    if (!goOn) return reach;
    ivec2 across = ivec2(way.y, way.x);
    for (int i = -1; i <= 1; i += 2) {
        uint neighbour = uint(int(seen.y) + i);   // below 0 it wraps to a large number
        if (reach >= 1.0 || neighbour >= triangleCountOf(seen.x - 1u) || !shareEdge(seen.x - 1u, seen.y, neighbour)) continue;
        vec2 span = spanOf(uvec2(seen.x, neighbour), pixel, way);
        if (span.x <= reach + 0.01 && span.y > reach) last = span, lastSeen.y = neighbour, reach = min(span.y, 1.0);
    }
    for (int i = 0; i < 4; ++i) {
        ivec2 near = pixel + (i < 2 ? ivec2(0) : way) + (i % 2 == 0 ? across : -across);
        uvec2 other = seenAt(near);
        bool isNext = reach < 1.0 && other.x != 0u && other != seen && other.x == seen.x;
        if (!isNext || objectSeen(other) != objectSeen(seen)) continue;
        vec2 span = spanOf(other, pixel, way);
        // Neighbours share an edge, so that one begins where the other ends: but for rounding.
        if (span.x <= reach + 0.01 && span.y > reach) last = span, lastSeen = other, reach = min(span.y, 1.0);
    }
    // Among triangles smaller than a pixel more will follow unseen: the object ends anywhere on the rest of the way. (Not so beyond a face seen nearly
    // edge-on, which is thin but long.)
    vec2 beside = spanOf(lastSeen, pixel + ivec2(round(clamp(0.5 * (last.x + last.y), 0.0, 1.0) * vec2(way))), across);
    if (last.y - last.x < 0.75 && beside.y - beside.x < 1.5) reach = 0.5 * (reach + 1.0);
    return reach;
}
