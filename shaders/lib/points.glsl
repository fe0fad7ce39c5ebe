// Points over a surface, compared with the depth buffer. Include after lib/space.glsl.

// A point is hidden if it lies behind the surface by more than the rounding of depths: eight half ulps of float
// (relative). More would blind long lenses, whose depths are large beside the radius.
const float DEPTH_SLACK = 5e-7;

// Depth at which the ray of `tap` passes `height` above the plane through `position` with `normal`. The kernel point
// would lie there if it lay on the centre of the pixel it falls on. 0 where the ray never gets there: nothing hides
// such a point.
float depthAtHeight(ivec2 tap, vec3 position, vec3 normal, float height) {
    vec2 ray = rayOf(tap);
    float level = dot(normal, position) + height;
    if (ORTHOGRAPHIC) return abs(normal.z) > 1e-6 ? (dot(normal.xy, ray) - level) / normal.z : 0.0;
    float slope = dot(normal, vec3(ray, -1.0));
    return abs(slope) > 1e-6 ? max(level / slope, 0.0) : 0.0;
}
