#version 450 core
// Two views in alternate rows (0), columns (1), squares (2) or subpixels (3) of the panel.

layout(binding = 0) uniform sampler2DArray view_array;  // sRGB-coded bytes; 0 left eye, 1 right eye
layout(location = 0) uniform int pattern;
layout(location = 1) uniform ivec3 window;  // place on the panel from its upper left corner, height
layout(location = 2) uniform int first;     // the eye at even places
layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 panel = window.xy + ivec2(pixel.x, window.z - 1 - pixel.y);
  ivec3 place = pattern == 0   ? ivec3(panel.y)
                : pattern == 1 ? ivec3(panel.x)
                : pattern == 2 ? ivec3(panel.x + panel.y)
                               : 3 * panel.x + ivec3(0, 1, 2);
  vec3 even = texelFetch(view_array, ivec3(pixel, first), 0).rgb;
  vec3 odd = texelFetch(view_array, ivec3(pixel, 1 - first), 0).rgb;
  color = vec4(mix(even, odd, equal(place & 1, ivec3(1))), 1.0);
}
