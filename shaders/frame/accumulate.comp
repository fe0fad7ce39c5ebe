// Adds a sample to the sum over a pixel's samples. The last one divides.

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(sum)))) return;
    vec4 total = texelFetch(source, pixel + params.offset, 0);
    if (!params.first) total += imageLoad(sum, pixel);
    imageStore(sum, pixel, params.last ? total * params.scale : total);
}
