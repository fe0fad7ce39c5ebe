// The likeness of two pixels' surfaces, for filters that must not mix different surfaces. Include after lib/space.glsl.

// Distance of a tap's surface from a pixel's tangent plane, in widths of a pixel there: 0 on a plane at any tilt, large
// across an outline.
float offPlane(vec3 position, vec3 normal, float perFootprint, ivec2 tap, float tapDepth) {
    return abs(dot(viewPosition(tap, tapDepth) - position, normal)) * perFootprint;
}

// 1 at 0, 0 from 1 on, smooth at both ends: a bell that is cheaper than a Gaussian and ends.
float bell(float x) {
    float rest = max(1.0 - x * x, 0.0);
    return rest * rest;
}
