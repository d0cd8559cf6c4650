#version 450 core
// A page over finished views. Its colours are multiplied by their alpha.

layout(binding = 0) uniform sampler2DArray page;
in vec2 place;
out vec4 color;

void main() { color = texture(page, vec3(place, 0.0)); }
