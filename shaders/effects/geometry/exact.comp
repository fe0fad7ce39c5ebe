// Resolves the visibility buffer: evaluates the visible triangle analytically, once per pixel, and only what the plan
// reads.
//
// It transforms the pixel's ray into mesh space, where the vertices are exactly as uploaded, and intersects it with the
// triangle's plane in double precision. Depth is right to half an ulp of the float it is stored in, at every distance
// and tilt.
#include "scene/scene.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#include "lib/seen.glsl"
#ifdef WRITES_surface_place
#include "lib/bits.glsl"
#endif
#if defined(WRITES_albedo) && defined(TEXTURED)
#include "lib/texture.glsl"
#endif

// A triangle in mesh space, and the transform there from view space.
struct Surface {
    MeshFromView meshFromView;
    dvec3 corner, edge1, edge2, plane;  // plane: edge1 × edge2
};

struct Hit {
    double depth;  // along the view axis
    vec2 weights;  // barycentric weights of the second and third corner
};

// The component of v in which `plane` is largest.
double along(dvec3 v, dvec3 plane) {
    dvec3 a = abs(plane);
    return a.x >= a.y && a.x >= a.z ? v.x : a.y >= a.z ? v.y : v.z;
}

Hit intersect(Surface s, dvec2 pixelCentre) {
    dvec2 ray = pixelCentre * view.rayScaleExact + view.rayOffsetExact;
    dvec3 origin = s.meshFromView.offset, direction;
    for (int i = 0; i < 3; ++i) {
        double sideways = dot(s.meshFromView.rows[i].xy, ray);
        // View space looks down -z, and a step of one along -z is a step of one in depth: mapping into mesh space keeps
        // t.
        direction[i] = (ORTHOGRAPHIC ? 0.0lf : sideways) - s.meshFromView.rows[i].z;
        if (ORTHOGRAPHIC) origin[i] += sideways;
    }
    double slope = dot(s.plane, direction);
    // If the triangle is exactly edge-on, the ray lies in its plane: any depth on it will do.
    double t = slope != 0.0lf ? dot(s.plane, s.corner - origin) / slope : 0.0lf;
    dvec3 q = origin + t * direction - s.corner;
    double size = along(s.plane, s.plane);
    return Hit(t,
        vec2(dvec2(along(cross(q, s.edge2), s.plane), along(cross(s.edge1, q), s.plane))
            / (size != 0.0lf ? size : 1.0lf)));
}

void writeBackground() {
#ifdef WRITES_depth
    write_depth(vec4(BACKGROUND_DEPTH));
#endif
#ifdef WRITES_normal
    write_normal(vec4(NO_NORMAL, 0, 0));
#endif
#ifdef WRITES_normal_geometric
    write_normal_geometric(vec4(NO_NORMAL, 0, 0));
#endif
#ifdef WRITES_position
    write_position(vec4(0));
#endif
#ifdef WRITES_motion
    write_motion(vec4(0));
#endif
#ifdef WRITES_surface_place
    write_surface_place(uvec4(0));
#endif
#ifdef WRITES_albedo
    write_albedo(vec4(0));
#endif
#ifdef WRITES_object_id
    write_object_id(uvec4(0));
#endif
#ifdef WRITES_material_id
    write_material_id(uvec4(0));
#endif
#ifdef WRITES_line_record
    write_line_record(uvec4(0));
#endif
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    uvec2 id = decodeSeen(load(visibility, (pixel + view.placeInCanvas) * view.raster + view.placeOnRaster));
    if (id.x == 0u) {
        writeBackground();
        return;
    }
    uint number = id.x - 1u, triangle = id.y;
    Instance instance = instanceAt(number);

#if defined(WRITES_depth) || defined(WRITES_normal) || defined(WRITES_normal_geometric) || defined(WRITES_position) \
    || defined(WRITES_motion) || defined(WRITES_surface_place)                                                      \
    || (defined(WRITES_albedo) && (defined(TEXTURED) || defined(VERTEX_COLORS)))
    ivec3 corners =
        int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + triangle)).xyz);
    vec3 p0 = texelFetch(positions, corners.x).xyz, p1 = texelFetch(positions, corners.y).xyz,
         p2 = texelFetch(positions, corners.z).xyz;
    Surface s;
    s.meshFromView = meshFromViewAt(number);
    s.corner = dvec3(p0);
    s.edge1 = dvec3(p1) - s.corner;
    s.edge2 = dvec3(p2) - s.corner;
    s.plane = cross(s.edge1, s.edge2);
    dvec2 centre = dvec2(pixel + view.origin) + 0.5lf;
    Hit hit = intersect(s, centre);
    // The centre may lie up to half a grid step outside the triangle: clamp, since a steep plane runs away there.
    vec3 z = -vec3(viewFromMesh(number, p0).z, viewFromMesh(number, p1).z, viewFromMesh(number, p2).z);
    float least = min(z.x, min(z.y, z.z)), most = max(z.x, max(z.y, z.z));
    // The bounds are floats: an ulp or two of room keeps them from cutting into exact depths.
    float room = 4e-7 * max(abs(least), abs(most));
    double depthHere = clamp(hit.depth, double(least - room), double(most + room));
    vec2 weights = clamp(hit.weights, 0.0, 1.0);
    weights.y = min(weights.y, 1.0 - weights.x);
#endif
#ifdef WRITES_depth
    write_depth(vec4(float(depthHere)));
#endif
#ifdef WRITES_position
    dvec2 ray = centre * view.rayScaleExact + view.rayOffsetExact;
    vec3 inView = vec3(dvec3(ORTHOGRAPHIC ? ray : ray * depthHere, -depthHere));
    write_position(vec4((view.worldFromView * vec4(inView, 1.0)).xyz, 0));
#endif
#ifdef WRITES_surface_place
    // Cells of two to four pixels, the sizes of which are powers of two: most pixels stay in theirs while things move.
    // (Measured under a slow pan: with half the size noise flickers more than noise that stays where the pixels are.)
    float pixelSize = float(view.rayScaleExact.x) * (ORTHOGRAPHIC ? 1.0 : float(depthHere))
        * length(vec3(s.meshFromView.rows[0].x, s.meshFromView.rows[1].x, s.meshFromView.rows[2].x));
    int size = int(floatBitsToUint(pixelSize) >> 23) - 125;  // the exponent of the power of two after the next
    vec3 cells = (p0 + weights.x * (p1 - p0) + weights.y * (p2 - p0)) * exp2(float(-size));
    // Flat faces often lie at round numbers: the borders of cells must not.
    uvec3 cell = uvec3(ivec3(floor(cells + vec3(0.37, 0.61, 0.43))));
    write_surface_place(uvec4(interleaved(cell) ^ mixBits(number * 64u + uint(size + 32))));
#endif
#ifdef WRITES_motion
    vec2 was = previousPixel(number, p0 + weights.x * (p1 - p0) + weights.y * (p2 - p0), vec2(centre));
    write_motion(vec4(vec2(centre) - was, 0, 0));
#endif
#if defined(WRITES_normal) || defined(WRITES_normal_geometric)
    // The plane's normal by the mesh's winding. Surfaces have two sides; the one that faces the eye is visible.
    vec3 outward = normalize(viewNormal(
        s.meshFromView, vec3(s.plane / max(max(abs(s.plane.x), abs(s.plane.y)), max(abs(s.plane.z), 1e-300lf)))));
    vec2 through = rayOf(pixel);
    bool fromBehind = ORTHOGRAPHIC ? outward.z < 0.0 : dot(outward, vec3(through, -1.0)) > 0.0;
    vec3 towardsViewer = fromBehind ? -outward : outward;
#endif
#ifdef WRITES_normal_geometric
    write_normal_geometric(vec4(encodeNormal(towardsViewer), 0, 0));
#endif
#ifdef WRITES_normal
    ivec3 at =
        int(instance.firstNormal) + ivec3(texelFetch(triangleNormals, int(instance.firstTriangle + triangle)).xyz);
    vec3 n0 = texelFetch(normals, at.x).xyz;
    vec3 between =
        n0 + weights.x * (texelFetch(normals, at.y).xyz - n0) + weights.y * (texelFetch(normals, at.z).xyz - n0);
    // Where opposite vertex normals cancel, the triangle's own normal is the best there is. Back sides turn normals
    // around.
    bool usable = dot(between, between) > 1e-8;
    vec3 turned = viewNormal(s.meshFromView, between) * (fromBehind ? -1.0 : 1.0);
    write_normal(vec4(encodeNormal(usable ? normalize(turned) : towardsViewer), 0, 0));
#endif
#ifdef WRITES_object_id
    write_object_id(uvec4(triangleObject(instance, triangle)));
#endif
#ifdef WRITES_line_record
    write_line_record(uvec4(triangleLineRecord(instance, triangle)));
#endif
#if defined(WRITES_material_id) || defined(WRITES_albedo)
    uint material = triangleMaterial(instance, triangle);
#endif
#ifdef WRITES_material_id
    write_material_id(uvec4(material + 1u));
#endif
#ifdef WRITES_albedo
    Material look = materialAt(material);
#ifdef TEXTURED
    ivec3 places = uvCorners(instance, triangle);
    vec2 uv = uvAt(places, weights);
    // The change of uv across the sample's part of the pixel, on the triangle's whole plane.
    double part = 1.0lf / double(view.raster);
    vec2 here = uvAt(places, hit.weights);
    vec2 uvX = uvAt(places, intersect(s, centre + dvec2(part, 0.0lf)).weights) - here;
    vec2 uvY = uvAt(places, intersect(s, centre + dvec2(0.0lf, part)).weights) - here;
    if (look.levels > 0) look.color *= sampleTexture(look, uv, uvX, uvY).rgb;
#endif
#ifdef VERTEX_COLORS
    uint colorWords = colorWordsOf(number);
    if (look.takesVertexColors && colorWords != NO_WORDS) {
        int first = int(colorWords + 3u * triangle);
        vec3 c0 = unpackColor(texelFetch(words, first).r), c1 = unpackColor(texelFetch(words, first + 1).r),
             c2 = unpackColor(texelFetch(words, first + 2).r);
        look.color *= c0 + weights.x * (c1 - c0) + weights.y * (c2 - c0);
    }
#endif
#ifdef HATCHED
    look.color = hatched(look, vec2(pixel + view.origin) + 0.5);
#endif
    write_albedo(vec4(look.color, 1));
#endif
}
