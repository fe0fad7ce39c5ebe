// Writes only which triangle is seen; exact.comp finds out everything else, once per pixel that is seen.

flat in uint instanceNumber;

void main() { visibility = uvec2(instanceNumber, uint(gl_PrimitiveID)); }
