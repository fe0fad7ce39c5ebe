// The classic G-buffer: what the hardware interpolated is what is written.
#include "frame/scene.glsl"
#include "lib/space.glsl"
#if defined(WRITES_albedo) && defined(TEXTURED)
#include "lib/texture.glsl"
in vec2 textureUv;
#endif
#ifdef WRITES_normal
in vec3 viewNormal;
#endif
#if defined(WRITES_position) || defined(WRITES_normal) || defined(WRITES_normal_geometric)
in vec3 viewPoint;
#endif
flat in uint instanceNumber;

void main() {
    uint triangle = uint(gl_PrimitiveID);
#ifdef WRITES_depth
    // The reversed depth that the rasterizer found: perspective depth is near / z, orthographic depth falls linearly from near to far.
    depth = view.orthographic ? view.far - gl_FragCoord.z * (view.far - view.near) : view.near / max(gl_FragCoord.z, 1e-37);
#endif
#ifdef WRITES_position
    position = vec4((view.worldFromView * vec4(viewPoint, 1.0)).xyz, 0);
#endif
#if defined(WRITES_normal) || defined(WRITES_normal_geometric)
    uint at = instances[instanceNumber].firstIndex + 3u * triangle;
    uvec3 corners = instances[instanceNumber].firstVertex + uvec3(indices[at], indices[at + 1u], indices[at + 2u]);
    // From the triangle, never from screen derivatives: those mix neighbouring triangles.
    vec3 first = meshPosition(corners.x);
    vec3 plane = cross(mat3(instances[instanceNumber].viewFromMesh) * (meshPosition(corners.y) - first), mat3(instances[instanceNumber].viewFromMesh) * (meshPosition(corners.z) - first));
    float area = length(plane);
    vec3 face = area > 0.0 ? plane / area : vec3(0, 0, 1);
    bool fromBehind = view.orthographic ? face.z < 0.0 : dot(face, viewPoint) > 0.0;
    vec3 towardsViewer = fromBehind ? -face : face;
#endif
#ifdef WRITES_normal_geometric
    normal_geometric = vec4(towardsViewer, 0);
#endif
#ifdef WRITES_normal
    float size = length(viewNormal);
    bool turned = fromBehind != (instances[instanceNumber].facing < 0.0);
    normal = vec4(size > 1e-4 ? (turned ? -viewNormal : viewNormal) / size : towardsViewer, 0);
#endif
#ifdef WRITES_object_id
    object_id = triangleObject(instanceNumber, triangle);
#endif
#if defined(WRITES_material_id) || defined(WRITES_albedo)
    uint material = triangleMaterial(instanceNumber, triangle);
#endif
#ifdef WRITES_material_id
    material_id = material + 1u;
#endif
#ifdef WRITES_albedo
    vec3 color = materials[material].color.rgb;
#ifdef TEXTURED
    vec2 uvX = dFdx(textureUv), uvY = dFdy(textureUv);
    if (materials[material].levels > 0) color *= sampleTexture(materials[material], textureUv, uvX, uvY).rgb;
#endif
    albedo = vec4(color, 1);
#endif
}
