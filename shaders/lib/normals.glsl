// Unit vectors in two numbers: the octahedral map (Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010). Two
// floats keep a direction to about 1e-7, the six axis directions exactly.

// Outside the map's square: no surface, no normal.
const vec2 NO_NORMAL = vec2(2.0, 0.0);

vec2 encodeNormal(vec3 n) {
    vec2 p = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : folded;
}

vec3 decodeNormal(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.xy -= vec2(n.x >= 0.0 ? fold : -fold, n.y >= 0.0 ? fold : -fold);
    return normalize(n);
}
