#version 450 core
// A rectangle of the world, as a strip of two triangles.

layout(location = 0) uniform vec4 corners[4];  // clip space: lower left, lower right, upper left, upper right
out vec2 place;

void main() {
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = corners[gl_VertexID];
}
