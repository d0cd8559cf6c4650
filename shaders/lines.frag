#version 450 core
// One colour.

layout(location = 2) uniform vec4 line_color;
layout(location = 0) out vec4 color;  // linear, premultiplied

void main() { color = line_color; }
