#version 450 core
// Two views mixed by colour matrices in linear light.

layout(binding = 0) uniform sampler2DArray view_array;  // sRGB-coded bytes; 0 left eye, 1 right eye
layout(location = 0) uniform mat3 left_matrix;
layout(location = 1) uniform mat3 right_matrix;
layout(location = 0) out vec4 color;

vec3 linear_from_srgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
vec3 srgb_from_linear(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 left = linear_from_srgb(texelFetch(view_array, ivec3(pixel, 0), 0).rgb);
  vec3 right = linear_from_srgb(texelFetch(view_array, ivec3(pixel, 1), 0).rgb);
  color = vec4(srgb_from_linear(left_matrix * left + right_matrix * right), 1.0);
}
