// Squares of pixels, for screen passes in the raster pipeline that want only a part of the picture.

layout(location = 0) in vec2 tile;  // its middle, in tiles
uniform int tilesX, tilesY;

void main() { gl_Position = vec4(tile / vec2(tilesX, tilesY) * 2.0 - 1.0, 0.0, 1.0); }
