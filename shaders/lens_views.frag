#version 450 core
// N views behind a lens sheet: which view each subpixel shows follows from its place on the panel (display/lens.h). The
// phase is split so that single precision keeps 1e-6 periods over 8192 pixels: step = coarse + fine, where a whole
// pixel number times coarse is exact.

const int kMaxCells = 10;

layout(binding = 0) uniform sampler2DArray view_array;  // linear light, 0 leftmost
layout(location = 0) uniform ivec4 window;    // lower left corner on the panel (from its lower left), size
layout(location = 1) uniform vec4 step_x;     // periods a pixel to the right: coarse, fine; upwards: coarse, fine
layout(location = 2) uniform float start;     // phase of the middle of the panel's lower left pixel
layout(location = 3) uniform ivec4 mode;      // views, filter, inverted, cell pattern
layout(location = 4) uniform float sigma;     // of the Gaussians, in views
layout(location = 5) uniform int cells;
layout(location = 6) uniform vec2 offsets[3 * kMaxCells];  // pixels
layout(location = 36) uniform float fringe;    // above 0: of even rows from the bottom, below: of odd ones
layout(location = 0) out vec4 color;

vec3 srgb_from_linear(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

int cell_of(ivec2 p) {
  int index = mode.w == 1 ? (p.x + p.y) % 2 : mode.w == 2 ? p.x % 2 : mode.w == 3 ? (p.y + 2 * (p.x % 2)) % 4
                                          : mode.w == 4 ? p.y % 2 : 0;
  return index % cells;
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
  ivec2 panel = window.xy + pixel;
  int cell = cell_of(panel);

  vec2 texel = (vec2(pixel) + 0.5) / vec2(window.zw) * vec2(textureSize(view_array, 0).xy) - 0.5;
  ivec2 low = ivec2(floor(texel)), last = textureSize(view_array, 0).xy - 1;
  ivec4 corner = ivec4(clamp(low, ivec2(0), last), clamp(low + 1, ivec2(0), last));
  vec2 mixing = texel - vec2(low);

  float whole = fract(float(panel.x) * step_x.x) + fract(float(panel.y) * step_x.z) + float(panel.x) * step_x.y +
                float(panel.y) * step_x.w + start;
  vec3 result = vec3(0.0);
  for (int k = 0; k < 3; ++k) {
    vec2 offset = offsets[3 * cell + k];
    float place = fract(whole + offset.x * (step_x.x + step_x.y) + offset.y * (step_x.z + step_x.w));
    float exact = (mode.z == 1 ? 1.0 - place : place) * float(mode.x);
    int near = clamp(int(floor(exact)), 0, mode.x - 1);
    if (mode.y == 0) {
      result[k] = sample_view(near, k, corner, mixing);
    } else if (mode.y == 1) {
      float blend = clamp(exact - float(near), 0.0, 1.0);
      result[k] = mix(sample_view(near, k, corner, mixing),
                      sample_view(min(near + 1, mode.x - 1), k, corner, mixing), blend);
    } else {
      int reach = mode.y == 2 ? 1 : 10;
      float sum = 0.0, weights = 0.0;
      float best = (clamp(round(exact), 0.0, float(mode.x - 1)) - exact) / sigma;  // else few views would underflow
      for (int view = max(0, near - reach); view <= min(mode.x - 1, near + reach); ++view) {
        float far = (float(view) - exact) / sigma;
        float weight = exp(0.5 * (best * best - far * far));
        sum += weight * sample_view(view, k, corner, mixing);
        weights += weight;
      }
      result[k] = sum / weights;
    }
  }
  bool dimmed = (panel.y % 2 == 0) == (fringe > 0.0);
  color = vec4(srgb_from_linear(result) * (dimmed ? 1.0 - abs(fringe) : 1.0), 1.0);
}
