// Adds up the samples of each output pixel: the fine pixels in it, over the sub-frames. The last one divides.

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(sum)))) return;
    vec4 total = vec4(0);
    for (int y = 0; y < view.raster; ++y)
        for (int x = 0; x < view.raster; ++x) total += texelFetch(source, pixel * view.raster + ivec2(x, y), 0);
    if (!params.first) total += imageLoad(sum, pixel);
    imageStore(sum, pixel, params.last ? total * params.scale : total);
}
