// sRGB transfer functions (IEC 61966-2-1).

vec3 linearToSrgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(0)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}
vec3 srgbToLinear(vec3 c) {
    return mix(c / 12.92, pow((max(c, vec3(0)) + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
