// The classic G-buffer: writes the attributes that the hardware interpolated.
#include "scene/scene.glsl"
#include "lib/space.glsl"
#include "lib/normals.glsl"
#if (defined(WRITES_albedo) && defined(TEXTURED)) || defined(CUTOUTS)
#include "lib/texture.glsl"
in vec2 uvBetween;
#endif
#if defined(WRITES_albedo) && defined(VERTEX_COLORS)
in vec3 colorBetween;
#endif
#ifdef WRITES_normal
in vec3 normalBetween;
#endif
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
in vec3 viewPoint;
#endif
flat in uint instanceNumber;

void main() {
    uint triangle = uint(gl_PrimitiveID);
#if (defined(WRITES_albedo) && defined(TEXTURED)) || defined(CUTOUTS)
    vec2 uvX = dFdx(uvBetween), uvY = dFdy(uvBetween);  // before any fragment is discarded
#endif
    Instance instance = instanceAt(instanceNumber);
#if defined(WRITES_material_id) || defined(WRITES_albedo) || defined(CUTOUTS)
    uint material = triangleMaterial(instance, triangle);
#endif
#ifdef CUTOUTS
    Material cut = materialAt(material);
    if (sampleTexture(cut, uvBetween, uvX, uvY).a < 0.5 && cut.hasHoles) discard;
#endif
#ifdef WRITES_depth
    // w is the depth along the view axis, and the rasterizer interpolates 1/w; orthographic depth falls linearly from
    // far to near.
    depth = ORTHOGRAPHIC ? view.clipFar - gl_FragCoord.z * (view.clipFar - view.near) : 1.0 / gl_FragCoord.w;
#endif
#ifdef WRITES_position
    position = vec4((view.worldFromView * vec4(viewPoint, 1.0)).xyz, 0);
#endif
#if defined(WRITES_normal) || defined(WRITES_normal_geometric)
    // From the triangle, never from screen derivatives: those mix neighbouring triangles.
    ivec3 corners =
        int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + triangle)).xyz);
    vec3 p0 = texelFetch(positions, corners.x).xyz, p1 = texelFetch(positions, corners.y).xyz,
         p2 = texelFetch(positions, corners.z).xyz;
    dvec3 plane = cross(dvec3(p1) - dvec3(p0), dvec3(p2) - dvec3(p0));
    vec3 outward = normalize(viewNormal(meshFromViewAt(instanceNumber),
        vec3(plane / max(max(abs(plane.x), abs(plane.y)), max(abs(plane.z), 1e-300lf)))));
    bool fromBehind = ORTHOGRAPHIC ? outward.z < 0.0 : dot(outward, viewPoint) > 0.0;
    vec3 towardsViewer = fromBehind ? -outward : outward;
#endif
#ifdef WRITES_normal_geometric
    normal_geometric = encodeNormal(towardsViewer);
#endif
#ifdef WRITES_normal
    float size = length(normalBetween);
    normal = encodeNormal(size > 1e-4 ? normalBetween * ((fromBehind ? -1.0 : 1.0) / size) : towardsViewer);
#endif
#ifdef WRITES_object_id
    object_id = triangleObject(instance, triangle);
#endif
#ifdef WRITES_line_record
    line_record = triangleLineRecord(instance, triangle);
#endif
#ifdef WRITES_material_id
    material_id = material + 1u;
#endif
#ifdef WRITES_albedo
    Material look = materialAt(material);
#ifdef TEXTURED
    if (look.levels > 0) look.color *= sampleTexture(look, uvBetween, uvX, uvY).rgb;
#endif
#ifdef VERTEX_COLORS
    if (look.takesVertexColors) look.color *= colorBetween;
#endif
#ifdef HATCHED
    look.color = hatched(look, gl_FragCoord.xy + vec2(view.origin));
#endif
    albedo = vec4(look.color, 1);
#endif
}
