// Ambient shading, or lines, or both, from how the depth image bends.
#include "lib/space.glsl"
#include "lib/depth_tangent.glsl"

// The paper's listing takes neighbours on the diagonals, its figure along the axes.
#ifdef AXIAL
const vec2 NEIGHBOURS[4] = vec2[](vec2(1, 0), vec2(-1, 0), vec2(0, 1), vec2(0, -1));
#else
const vec2 NEIGHBOURS[4] = vec2[](vec2(1, 1), vec2(-1, -1), vec2(1, -1), vec2(-1, 1));
#endif

float depthAt(ivec2 pixel) { return load(depth, clamp(pixel, ivec2(0), view.size - 1)).r; }

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
        float p = (here - distanceAt(pixel + ivec2(round(NEIGHBOURS[i] * params.reach)))) * params.perRange;
#ifdef NORMALIZED_TANGENT
        p /= length(vec3(NEIGHBOURS[i] * params.step, p));
#endif
        sum += 0.25 * openAt(p, params.perBleach, params.brightness);
    }
#else
    float here = depthAt(pixel);
#ifndef ABSENCE_IS_FAR
    if (isBackground(here)) {
        write_result(vec4(1));
        return;
    }
#endif
    // Each ring turns by 52 degrees against the last, so that no two of them line up.
    vec2 turned = NEIGHBOURS[0];
    for (int ring = RINGS; ring > 0; --ring) {
        float reach = params.reach * float(ring) / float(RINGS);
        for (int i = 0; i < 2; ++i) {
            // Whole pixels, so that opposite neighbours lie opposite.
            ivec2 offset = ivec2(round(turned * reach));
            turned = vec2(-turned.y, turned.x);
            float one = depthAt(pixel + offset), other = depthAt(pixel - offset);
            bool someAbsent = isBackground(one) || isBackground(other) || isBackground(here);
            float p = someAbsent || offset == ivec2(0) ? 0.0 : (here - betweenOpposite(one, other)) * params.perRange;
#ifdef ABSENCE_IS_FAR
            // A surface that ends before the background is a line; background beside background is none.
            bool allAbsent = isBackground(one) && isBackground(other) && isBackground(here);
            if (someAbsent) p = allAbsent ? 0.0 : 1.0 / params.perBleach;
#endif
                // For ambient shading an absent neighbour tells nothing about the surface's bend.
#ifdef ALL_BENDS
            p = abs(p);
#endif
            sum += openAt(max(p, 0.0), params.perBleach, params.brightness) / float(2 * RINGS);
        }
        turned = mat2(0.6157, 0.7880, -0.7880, 0.6157) * turned;
    }
#endif
    float open = pow(clamp(sum, 0.0, 1.0), params.contrast);
#ifdef AS_LINES
    vec4 color = params.color * (1.0 - open);
#ifdef LAYERS_BELOW
    color += load(layersBelow, pixel) * (1.0 - color.a);
#endif
    write_result(color);
#else
    write_result(vec4(open));
#endif
}
