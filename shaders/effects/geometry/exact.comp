// Resolves the visibility buffer: evaluates, analytically and for each pixel, just what the plan reads of the triangle seen there.
//
// The triangle's plane and the ray are intersected in double precision: the depth of a plane is right to half an ulp of the float it
// is stored in, at every distance, tilt and size of triangle.
#include "frame/scene.glsl"
#include "lib/space.glsl"
#if defined(WRITES_albedo) && defined(TEXTURED)
#include "lib/texture.glsl"
#endif

struct Hit {
    double depth;       // along the view axis
    vec2 weights;       // barycentric weights of the second and third corner
};

// A triangle in view space, seen from pixels.
struct Surface {
    dvec3 corner, edge1, edge2, plane;   // plane: edge1 × edge2
    double area;                         // squared length of plane
};

// `bounded`: keep to the triangle. Texture gradients look at the neighbouring pixels' rays and must not be.
Hit intersect(Surface s, dvec2 pixelCentre, bool bounded) {
    dvec2 ray = pixelCentre * view.rayScaleExact + view.rayOffsetExact;
    dvec3 origin = view.orthographic ? dvec3(ray, 0.0) : dvec3(0.0);
    dvec3 direction = view.orthographic ? dvec3(0.0, 0.0, -1.0) : dvec3(ray, -1.0);
    double slope = dot(s.plane, direction);
    // Seen exactly edge-on the ray lies in the plane: take the first corner's depth.
    double t = slope != 0.0 ? dot(s.plane, s.corner - origin) / slope : -s.corner.z;
    // The pixel's centre may lie up to half a grid step outside: a steep plane must not run away there.
    double z1 = -s.corner.z, z2 = z1 - s.edge1.z, z3 = z1 - s.edge2.z;
    if (bounded) t = clamp(t, min(z1, min(z2, z3)), max(z1, max(z2, z3)));
    dvec3 q = origin + t * direction - s.corner;
    vec2 weights = vec2(dot(cross(q, s.edge2), s.plane) / s.area, dot(cross(s.edge1, q), s.plane) / s.area);
    if (bounded) {
        weights = clamp(weights, 0.0, 1.0);
        weights.y = min(weights.y, 1.0 - weights.x);
    }
    return Hit(t, weights);
}

vec2 uvAt(uvec3 corners, vec2 weights) {
    vec2 first = meshUv(corners.x);
    return first + weights.x * (meshUv(corners.y) - first) + weights.y * (meshUv(corners.z) - first);
}

void storeBackground(ivec2 pixel) {
#ifdef WRITES_depth
    imageStore(depth, pixel, vec4(BACKGROUND_DEPTH));
#endif
#ifdef WRITES_normal
    imageStore(normal, pixel, vec4(0));
#endif
#ifdef WRITES_normal_geometric
    imageStore(normal_geometric, pixel, vec4(0));
#endif
#ifdef WRITES_position
    imageStore(position, pixel, vec4(0));
#endif
#ifdef WRITES_albedo
    imageStore(albedo, pixel, vec4(0));
#endif
#ifdef WRITES_object_id
    imageStore(object_id, pixel, uvec4(0));
#endif
#ifdef WRITES_material_id
    imageStore(material_id, pixel, uvec4(0));
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!insideRegion(pixel)) return;
    uvec2 id = texelFetch(visibility, pixel, 0).xy;
    if (id.x == 0u) {
        storeBackground(pixel);
        return;
    }
    uint instance = id.x - 1u, triangle = id.y;
    uint at = instances[instance].firstIndex + 3u * triangle;
    uvec3 corners = instances[instance].firstVertex + uvec3(indices[at], indices[at + 1u], indices[at + 2u]);

#if defined(WRITES_depth) || defined(WRITES_normal) || defined(WRITES_normal_geometric) || defined(WRITES_position) || (defined(WRITES_albedo) && defined(TEXTURED))
    dmat4 viewFromMesh = instances[instance].viewFromMesh;
    dvec3 first = dvec3(meshPosition(corners.x));
    Surface s;
    s.corner = dvec3(viewFromMesh * dvec4(first, 1.0));
    s.edge1 = dmat3(viewFromMesh) * (dvec3(meshPosition(corners.y)) - first);
    s.edge2 = dmat3(viewFromMesh) * (dvec3(meshPosition(corners.z)) - first);
    s.plane = cross(s.edge1, s.edge2);
    s.area = max(dot(s.plane, s.plane), 1e-300lf);
    dvec2 centre = dvec2(pixel + view.origin) + 0.5lf;
    Hit hit = intersect(s, centre, true);
#endif
#ifdef WRITES_depth
    imageStore(depth, pixel, vec4(float(hit.depth)));
#endif
#ifdef WRITES_position
    dvec2 ray = centre * view.rayScaleExact + view.rayOffsetExact;
    vec3 inView = vec3(dvec3(view.orthographic ? ray : ray * hit.depth, -hit.depth));
    imageStore(position, pixel, vec4((view.worldFromView * vec4(inView, 1.0)).xyz, 0));
#endif
#if defined(WRITES_normal) || defined(WRITES_normal_geometric)
    vec3 face = vec3(s.plane / sqrt(s.area));
    // Surfaces have two sides; a mirrored instance turns its triangles around.
    bool fromBehind = dot(s.plane, s.corner) * double(view.orthographic ? 0.0 : 1.0) - (view.orthographic ? s.plane.z : 0.0lf) > 0.0;
    vec3 towardsViewer = fromBehind ? -face : face;
#endif
#ifdef WRITES_normal_geometric
    imageStore(normal_geometric, pixel, vec4(towardsViewer, 0));
#endif
#ifdef WRITES_normal
    vec3 n0 = meshNormal(corners.x);
    vec3 smoothNormal = n0 + hit.weights.x * (meshNormal(corners.y) - n0) + hit.weights.y * (meshNormal(corners.z) - n0);
    smoothNormal = mat3(instances[instance].viewNormalFromMesh) * smoothNormal;
    float size = length(smoothNormal);
    // Opposite vertex normals cancel: then the triangle's own normal is the best there is. A hidden side shows its normals turned.
    bool turned = fromBehind != (instances[instance].facing < 0.0);
    imageStore(normal, pixel, vec4(size > 1e-4 ? (turned ? -smoothNormal : smoothNormal) / size : towardsViewer, 0));
#endif
#ifdef WRITES_object_id
    imageStore(object_id, pixel, uvec4(triangleObject(instance, triangle)));
#endif
#if defined(WRITES_material_id) || defined(WRITES_albedo)
    uint material = triangleMaterial(instance, triangle);
#endif
#ifdef WRITES_material_id
    imageStore(material_id, pixel, uvec4(material + 1u));
#endif
#ifdef WRITES_albedo
    vec3 color = materials[material].color.rgb;
#ifdef TEXTURED
    if (materials[material].levels > 0) {
        vec2 uv = uvAt(corners, hit.weights);
        vec2 uvX = uvAt(corners, intersect(s, centre + dvec2(1.0, 0.0), false).weights) - uv;
        vec2 uvY = uvAt(corners, intersect(s, centre + dvec2(0.0, 1.0), false).weights) - uv;
        color *= sampleTexture(materials[material], uv, uvX, uvY).rgb;
    }
#endif
    imageStore(albedo, pixel, vec4(color, 1));
#endif
}
