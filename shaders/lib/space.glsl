// Pixels, rays and view space (right-handed, camera at the origin, looking down -z, normalized units).
//
// A `pixel` is a texel of the screen textures: a pixel of the region being drawn, counted from its lower left.

// What `depth` holds where nothing was hit.
const float BACKGROUND_DEPTH = 3.402823466e38;

bool isBackground(float depth) { return depth == BACKGROUND_DEPTH; }

bool insideRegion(ivec2 pixel) { return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, view.size)); }

// View-space xy at unit depth of a pixel's centre; for an orthographic camera its xy.
vec2 rayOf(ivec2 pixel) { return (vec2(pixel + view.origin) + 0.5) * view.rayScale + view.rayOffset; }

vec3 viewPosition(ivec2 pixel, float depth) {
    vec2 ray = rayOf(pixel);
    return vec3(view.orthographic ? ray : ray * depth, -depth);
}

// Unit vector from a view-space position towards the eye.
vec3 towardsEye(vec3 position) { return view.orthographic ? vec3(0, 0, 1) : normalize(-position); }

// The pixel that a view-space position falls on, with fraction: centres lie at +0.5. Needs position.z < 0 unless orthographic.
vec2 pixelOf(vec3 position) {
    vec2 ray = view.orthographic ? position.xy : position.xy / -position.z;
    return (ray - view.rayOffset) / view.rayScale - vec2(view.origin);
}

// Width of a pixel at a depth, in normalized units.
float pixelFootprint(float depth) { return view.rayScale.x * (view.orthographic ? 1.0 : depth); }
