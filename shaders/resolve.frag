#version 450 core
// Averages factor x factor samples in linear light and codes the result as sRGB with straight alpha.

layout(binding = 0) uniform sampler2D sample_image;  // linear, premultiplied
layout(location = 0) uniform int factor;
layout(location = 0) out vec4 color;

vec3 srgb_from_linear(vec3 c) {
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * factor;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) {
      vec4 sample_color = texelFetch(sample_image, first + ivec2(x, y), 0);
      sum += vec4(min(sample_color.rgb, vec3(sample_color.a)), sample_color.a);
    }
  sum /= float(factor * factor);
  vec3 straight = sum.a > 0.0 ? clamp(sum.rgb / sum.a, 0.0, 1.0) : vec3(0.0);
  color = vec4(srgb_from_linear(straight), sum.a);
}
