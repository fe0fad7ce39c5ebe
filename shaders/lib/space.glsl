// Pixels, rays and view space (right-handed, camera at the origin, looking down -z, normalized units).
//
// A `pixel` is a texel of the screen textures: a pixel of the region being drawn, counted from its lower left. In
// passes at half resolution (COARSENESS 2) it is every second pixel each way, at that pixel's own place, not between
// four of them.
#ifndef COARSENESS
#define COARSENESS 1
#endif

// The background's value in `depth`.
const float BACKGROUND_DEPTH = 3.402823466e38;

bool isBackground(float depth) { return depth == BACKGROUND_DEPTH; }

bool insideRegion(ivec2 pixel) {
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel * COARSENESS, view.size));
}

// View-space xy at unit depth of a pixel's centre; for an orthographic camera its xy.
vec2 rayOf(ivec2 pixel) { return (vec2(pixel * COARSENESS + view.origin) + 0.5) * view.rayScale + view.rayOffset; }

vec3 viewPosition(ivec2 pixel, float depth) {
    vec2 ray = rayOf(pixel);
    return vec3(ORTHOGRAPHIC ? ray : ray * depth, -depth);
}

// Unit vector from a view-space position towards the eye.
vec3 towardsEye(vec3 position) { return ORTHOGRAPHIC ? vec3(0, 0, 1) : normalize(-position); }

// The pixel that a view-space position falls on. Needs position.z < 0 unless orthographic. Rounds its place in the
// whole picture, so that every tile rounds alike.
ivec2 pixelOf(vec3 position) {
    vec2 ray = ORTHOGRAPHIC ? position.xy : position.xy / -position.z;
    vec2 at = (ray - view.rayOffset) / view.rayScale;
    ivec2 origin = view.origin / COARSENESS;  // even, where pixels are coarse
    return ivec2(floor(COARSENESS == 1 ? at : (at - 0.5) / float(COARSENESS) + 0.5)) - origin;
}

// The pixel at an offset from another's centre. Rounds the offset, not the sum, so that every tile rounds alike.
ivec2 pixelFrom(ivec2 pixel, vec2 offset) { return pixel + ivec2(floor(offset + 0.5)); }

// Width of a pixel at a depth, in normalized units.
float pixelFootprint(float depth) { return float(COARSENESS) * view.rayScale.x * (ORTHOGRAPHIC ? 1.0 : depth); }
