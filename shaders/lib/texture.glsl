// Textures of materials, all in one array of layers. The shader filters single texels itself, so that the result is not
// the driver's choice.

layout(binding = 15) uniform sampler2DArray atlas;  // sRGB: texels come out linear

// The origin of a mip level: level 0 at the place, level 1 to its right, the others in a column under level 1.
ivec2 levelOrigin(ivec2 size, int level) {
    ivec2 origin = ivec2(level > 0 ? size.x : 0, 0);
    for (int l = 1; l < level; ++l) origin.y += max(size.y >> l, 1);
    return origin;
}

// Bilinear. With sharp texels the blend from one to the next is as wide as a pixel: `footprint` is a pixel's size in
// texels.
vec4 sampleLevel(Material material, vec2 uv, int level, vec2 footprint) {
    ivec2 size = max(material.place.zw >> level, ivec2(1));
    ivec2 base = material.place.xy + levelOrigin(material.place.zw, level);
    vec2 at = (material.repeats ? fract(uv) : clamp(uv, 0.0, 1.0)) * vec2(size) - 0.5;
    vec2 cell = floor(at), f = at - cell;
    ivec2 lo = ivec2(cell), hi = lo + 1;
    lo = material.repeats ? (lo + size) % size : max(lo, ivec2(0));
    hi = material.repeats ? hi % size : min(hi, size - 1);
    if (material.isSharp && level == 0) f = clamp((f - 0.5) / min(footprint, vec2(1.0)) + 0.5, 0.0, 1.0);
    vec4 a = texelFetch(atlas, ivec3(base + lo, material.layer), 0),
         b = texelFetch(atlas, ivec3(base + ivec2(hi.x, lo.y), material.layer), 0);
    vec4 c = texelFetch(atlas, ivec3(base + ivec2(lo.x, hi.y), material.layer), 0),
         d = texelFetch(atlas, ivec3(base + hi, material.layer), 0);
    return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}

// Trilinear; uvX and uvY are uv's changes from one pixel to the next.
vec4 sampleTexture(Material material, vec2 uv, vec2 uvX, vec2 uvY) {
    vec4 placing = texturePlacing(material);
    uv = uv * placing.xy + placing.zw;
    vec2 size = vec2(material.place.zw), acrossX = uvX * placing.xy * size, acrossY = uvY * placing.xy * size;
    // The geometric mean of the footprint's sides: between the blur of the longer side and the aliasing of the shorter
    // one.
    float area = max(length(acrossX), 1e-9) * max(length(acrossY), 1e-9);
    float level = clamp(0.5 * log2(area), 0.0, float(max(material.levels - 1, 0)));
    int lower = int(level);
    vec2 footprint = max(abs(acrossX) + abs(acrossY), vec2(1e-6));
    return mix(sampleLevel(material, uv, lower, footprint),
        sampleLevel(material, uv, min(lower + 1, max(material.levels - 1, 0)), footprint), level - float(lower));
}
