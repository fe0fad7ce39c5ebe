// Holes of materials in triangles: there is nothing where the texture's alpha is below one half. For raster passes.
#include "lib/texture.glsl"

// Is there a hole at this point of a triangle, in mesh units? Call it for all fragments: it takes derivatives. Its
// answer is the same from every view.
bool isHole(uint number, uint triangle, vec3 point) {
    Instance instance = instanceAt(number);
    ivec3 corners =
        int(instance.firstVertex) + ivec3(texelFetch(triangles, int(instance.firstTriangle + triangle)).xyz);
    vec3 p0 = texelFetch(positions, corners.x).xyz;
    vec3 edge1 = texelFetch(positions, corners.y).xyz - p0, edge2 = texelFetch(positions, corners.z).xyz - p0;
    // Scaled to about 1, so that no square leaves float's range.
    vec3 sides = max(abs(edge1), abs(edge2));
    float scale = 1.0 / max(max(sides.x, sides.y), max(sides.z, 1e-30));
    edge1 *= scale, edge2 *= scale;
    vec3 off = (point - p0) * scale, plane = cross(edge1, edge2);
    vec2 weights = vec2(dot(cross(off, edge2), plane), dot(cross(edge1, off), plane)) / max(dot(plane, plane), 1e-30);
    vec2 uv = uvAt(uvCorners(instance, triangle), weights);
    Material look = materialAt(triangleMaterial(instance, triangle));
    float alpha = sampleTexture(look, uv, dFdx(uv), dFdy(uv)).a;
    return look.hasHoles && alpha < 0.5;
}
