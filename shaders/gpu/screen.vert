// One triangle that covers everything, for devices that run screen passes in the raster pipeline.

// Constants are handed on to the fragment shader by a function that is generated.
void main() {
    handOn();
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
