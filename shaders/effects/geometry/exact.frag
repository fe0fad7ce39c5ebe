// Writes only which triangle is seen; exact.comp finds out everything else, once per pixel that is seen.

flat in uvec2 seen;

void main() { visibility = seen; }
