// Ambient shading from how the depth image bends (paper 002).
#include "lib/space.glsl"
#include "lib/depth_tangent.glsl"

const ivec2 NEIGHBOURS[4] =
#ifdef AXIAL
    ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
#else
    ivec2[](ivec2(1, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1));
#endif

float depthAt(ivec2 pixel) { return texelFetch(depth, clamp(pixel, ivec2(0), view.size - 1), 0).r; }

// The paper's distance to the camera.
float distanceAt(ivec2 pixel) {
    float z = depthAt(pixel);
    float d = isBackground(z) ? params.far : length(viewPosition(pixel, z));
#ifdef SQUARED_DEPTH
    return d * d;
#else
    return d;
#endif
}

void main() {
    ivec2 pixel = thisPixel();
    if (!insideRegion(pixel)) return;
    float sum = 0.0;
#ifdef SINGLE
    float here = distanceAt(pixel);
    for (int i = 0; i < 4; ++i) {
        float p = (here - distanceAt(pixel + NEIGHBOURS[i] * params.reach)) * params.perRange;
#ifdef NORMALIZED_TANGENT
        p /= length(vec3(vec2(NEIGHBOURS[i]) * params.step, p));
#endif
        sum += 0.25 * openAt(p, params.perBleach, params.brightness);
    }
#else
    float here = depthAt(pixel);
    if (isBackground(here)) {
        write_result(vec4(1));
        return;
    }
    for (int i = 0; i < 4; i += 2) {
        float one = depthAt(pixel + NEIGHBOURS[i] * params.reach), other = depthAt(pixel + NEIGHBOURS[i + 1] * params.reach);
        // A neighbour's absence tells nothing about how the surface bends.
        float p = isBackground(one) || isBackground(other) ? 0.0 : (here - betweenOpposite(one, other)) * params.perRange;
        sum += 0.5 * openAt(max(p, 0.0), params.perBleach, params.brightness);
    }
#endif
    write_result(vec4(pow(clamp(sum, 0.0, 1.0), params.contrast)));
}
