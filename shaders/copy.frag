#version 450 core
// One layer, pixel by pixel, placed with its lower left corner at `origin`.

layout(binding = 0) uniform sampler2DArray view_array;  // sRGB-coded bytes
layout(location = 0) uniform int layer;
layout(location = 1) uniform ivec2 origin;
layout(location = 0) out vec4 color;

void main() {
  color = vec4(texelFetch(view_array, ivec3(ivec2(gl_FragCoord.xy) - origin, layer), 0).rgb, 1.0);
}
