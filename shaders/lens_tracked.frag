#version 450 core
// Two views behind a lens sheet, woven for the places of two eyes with exact refraction (display/lens.h): a subpixel
// belongs to the eye for which its lens phase is nearer to 0.

layout(binding = 0) uniform sampler2DArray view_array;  // sRGB-coded bytes; 0 left eye, 1 right eye
layout(location = 0) uniform ivec4 window;   // lower left corner on the panel (from its lower left), size
layout(location = 1) uniform ivec2 panel_px;
layout(location = 2) uniform vec2 pixel_mm;
layout(location = 3) uniform vec4 lens;      // pitch mm, tangent of the slant, reduced gap mm, 1 - 1 / n^2
layout(location = 4) uniform float phase0;
layout(location = 5) uniform vec3 eyes_mm[2];
layout(location = 7) uniform vec2 offsets[3];  // pixels
layout(location = 0) out vec4 color;

float phase_from(vec3 eye, vec2 point) {
  vec2 to_eye = eye.xy - point;
  vec2 at_lens = point + lens.z * to_eye * inversesqrt(eye.z * eye.z + lens.w * dot(to_eye, to_eye));
  float phase = (at_lens.x + lens.y * at_lens.y) / lens.x - phase0;
  return abs(phase - round(phase));
}

float sample_view(int layer, int channel, ivec4 corner, vec2 mixing) {
  float a = texelFetch(view_array, ivec3(corner.xy, layer), 0)[channel];
  float b = texelFetch(view_array, ivec3(corner.zy, layer), 0)[channel];
  float c = texelFetch(view_array, ivec3(corner.xw, layer), 0)[channel];
  float d = texelFetch(view_array, ivec3(corner.zw, layer), 0)[channel];
  return mix(mix(a, b, mixing.x), mix(c, d, mixing.x), mixing.y);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 texel = (vec2(pixel) + 0.5) / vec2(window.zw) * vec2(textureSize(view_array, 0).xy) - 0.5;
  ivec2 low = ivec2(floor(texel)), last = textureSize(view_array, 0).xy - 1;
  ivec4 corner = ivec4(clamp(low, ivec2(0), last), clamp(low + 1, ivec2(0), last));
  vec2 from_centre = vec2(window.xy + pixel) + 0.5 - 0.5 * vec2(panel_px);
  for (int k = 0; k < 3; ++k) {
    vec2 point = (from_centre + offsets[k]) * pixel_mm;
    int eye = phase_from(eyes_mm[1], point) < phase_from(eyes_mm[0], point) ? 1 : 0;
    color[k] = sample_view(eye, k, corner, texel - vec2(low));
  }
  color.a = 1.0;
}
