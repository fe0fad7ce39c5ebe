// One triangle that covers everything, for devices that run screen passes in the raster pipeline.

// A generated function hands constants on to the fragment shader.
void main() {
    handOn();
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
