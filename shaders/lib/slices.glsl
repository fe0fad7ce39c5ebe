// Slices through the hemisphere over a surface point: planes that contain the line of sight. The picture shows such a
// plane as one straight line, so marching along that line finds the slice's horizon.
//
// Angles in a slice are counted from the direction to the eye, positive on the side of `across`. A slice sees the
// cosine-weighted hemisphere as the integral of cos(angle − normal's angle)·|sin angle| over its open angles, times the
// length of the normal's projection into it (Jiménez et al., "Practical Real-Time Strategies for Accurate Indirect
// Occlusion", 2016).
//
// Include after lib/space.glsl.

const float HALF_PI = 1.570796327;

// acos of 0 … 1, to 7e-5: software renderers take ten times as long for the real one (Lagarde 2014, after Abramowitz &
// Stegun 4.4.45).
float acosPositive(float x) {
    return sqrt(max(1.0 - x, 0.0)) * (1.5707963 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
}

float asinSigned(float x) {
    float a = HALF_PI - acosPositive(abs(x));
    return x < 0.0 ? -a : a;
}

// Directions across the line of sight.
struct SightFrame {
    vec3 toEye, right, up;
};

SightFrame sightFrame(vec3 position) {
    vec3 toEye = towardsEye(position);
    // Visible points lie in front of the eye: toEye.z > 0.
    vec3 right = normalize(vec3(toEye.z, 0.0, -toEye.x));
    return SightFrame(toEye, right, cross(toEye, right));
}

struct Slice {
    vec2 onScreen;  // movement of the point's image, in pixels, per normalized unit that the point moves `across`
    vec3 tangent;   // in the slice, along the surface, on the side of `across`
    vec3 upward;    // the normal over its projection's length: measures heights in the slice
    float weight;   // length of the normal's projection into the slice
    float sinN, cosN, angleN;  // of the normal's projection
};

// `turn`: cosine and sine of the slice's angle about the line of sight.
Slice sliceAt(SightFrame sight, vec3 position, vec3 normal, vec2 turn) {
    Slice s;
    vec3 across = turn.x * sight.right + turn.y * sight.up;
    float n = dot(normal, across), v = dot(normal, sight.toEye);
    // A slice perpendicular to the normal sees nothing of the hemisphere; its angles only need to stay finite.
    s.weight = max(length(vec2(n, v)), 1e-3);
    s.sinN = clamp(n / s.weight, -1.0, 1.0);
    s.cosN = clamp(v / s.weight, 0.0, 1.0);
    s.angleN = asinSigned(s.sinN);
    s.tangent = across * s.cosN - sight.toEye * s.sinN;
    s.upward = normal / s.weight;
    float depth = -position.z;
    s.onScreen = (ORTHOGRAPHIC ? across.xy : (across.xy + position.xy * (across.z / depth)) / depth)
        / (view.rayScale * float(COARSENESS));
    return s;
}

// Another point's place in the slice: x along the surface, y above it. Exact for points of the slice. Taps lie on pixel
// centres beside the slice's line; they keep their height above the surface, so that a plane stays flat at every tilt.
vec2 inSlice(Slice s, vec3 offset) { return vec2(dot(offset, s.tangent), dot(offset, s.upward)); }

// Visible part of one side of a slice (side: 1 or -1), from the line of sight to a horizon whose cosine to the normal's
// projection is `rise`.
float openArc(Slice s, float side, float rise) {
    float sinN = s.sinN * side, away = acosPositive(rise), sinAway = sqrt(max(1.0 - rise * rise, 0.0));
    // The horizon's angle is that of the normal plus `away`. The visible point lies in front of everything: an angle
    // below 0 is rounding.
    float angle = max(s.angleN * side + away, 0.0);
    float sinAngle = max(sinN * rise + s.cosN * sinAway, 0.0), cosAngle = s.cosN * rise - sinN * sinAway;
    // The integral is (cos n + 2·angle·sin n − cos(2·angle − n)) / 4.
    float cosTwice = 1.0 - 2.0 * sinAngle * sinAngle, sinTwice = 2.0 * sinAngle * cosAngle;
    return 0.25 * (s.cosN + 2.0 * angle * sinN - (cosTwice * s.cosN + sinTwice * sinN));
}

// The length, in pixels, of the march along a slice from the point: to the visible edge of the radius' sphere, and not
// beyond the region drawn.
float marchLength(Slice s, ivec2 pixel, vec2 direction, float speed, vec3 position, float radius) {
    float share = ORTHOGRAPHIC ? 0.0 : radius * inversesqrt(dot(position, position));
    // A distant sphere looks larger than a disk of its radius; near the eye it fills the picture.
    float far = share < 0.99 ? speed * radius * inversesqrt(1.0 - share * share) : 1e9;
    vec2 last = vec2((view.size - 1) / COARSENESS) - vec2(pixel);
    vec2 room = mix(vec2(pixel), last, greaterThan(direction, vec2(0)));
    vec2 steps = (room + 0.499) / max(abs(direction), vec2(1e-6));
    return min(far, min(steps.x, steps.y));
}

// A step's place along the march, 0 … 1: evenly spread, or with `growth` 1 by the square, denser near the point.
float stepReach(float share, float growth) { return share * mix(1.0, share, growth); }

// The pixel that a step of the march falls on. Steps are at least a pixel long, so it is another pixel except at the
// border of the region drawn.
ivec2 tapAt(ivec2 pixel, vec2 direction, float reach) {
    return clamp(pixelFrom(pixel, direction * reach), ivec2(0), (view.size - 1) / COARSENESS);
}
