// Squares of pixels, for devices that run screen passes in the raster pipeline, where only a part of the picture is
// wanted.

layout(location = 0) in vec2 tile;  // its middle, in tiles
uniform int tilesX, tilesY;

void main() { gl_Position = vec4(tile / vec2(tilesX, tilesY) * 2.0 - 1.0, 0.0, 1.0); }
