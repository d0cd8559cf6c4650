#version 450 core
// A view between two drawn ones (A nearer, B on the other side), pixel by pixel from their colours and depths. Cameras
// stand in one row, so a point moves along its row only, by slope * depth + offset (display/reproject.h). The surface
// that lands on this pixel is searched in A, then in B; what neither has seen is taken from behind the gap.

layout(binding = 0) uniform sampler2DArray view_array;   // sRGB-coded bytes
layout(binding = 1) uniform sampler2DArray depth_array;
layout(location = 0) uniform ivec2 key;       // layers of A and B
layout(location = 1) uniform vec4 shift;      // slope and offset in pixels, of A, of B
layout(location = 2) uniform ivec4 reach;     // first and last pixel to look at, from this one; of A, of B
layout(location = 3) uniform float far_depth;  // of the object: the background stands there
layout(location = 0) out vec4 color;

const float kTorn = 1.0;  // neighbours whose shifts differ by more pixels belong to different surfaces

struct Find {
  float depth, place;          // the nearest surface that lands here, and where in the key; depth 2: none
  float gap_depth, gap_place;  // the far side of a tear over this pixel; depth -1: none
};

/// Half a pixel of a surface that ends here: `ahead` is how far this pixel lies from the sample, away from its surface.
void edge(inout Find find, float depth, float place, float ahead) {
  if (ahead >= 0.0 && ahead <= 0.5 && depth < find.depth) {
    find.depth = depth;
    find.place = place;
  }
}

Find search(int layer, vec2 s, ivec2 range) {
  Find find = Find(2.0, 0.0, -1.0, 0.0);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int first = max(range.x, -pixel.x), last = min(range.y, textureSize(depth_array, 0).x - 1 - pixel.x);
  float depth_before = 0.0, landing_before = 0.0;
  for (int i = first; i <= last; ++i) {
    float depth = min(texelFetch(depth_array, ivec3(pixel.x + i, pixel.y, layer), 0).r, far_depth);
    float landing = float(i) + s.x * depth + s.y;
    float place = float(pixel.x + i);
    if (i == first) {
      edge(find, depth, place, landing);
    } else if (abs(s.x * (depth - depth_before)) < kTorn) {
      if (landing_before <= 0.0 && landing >= 0.0) {
        float t = landing > landing_before ? -landing_before / (landing - landing_before) : 0.0;
        float between = mix(depth_before, depth, t);
        if (between < find.depth) {
          find.depth = between;
          find.place = place - 1.0 + t;
        }
      }
    } else {
      edge(find, depth_before, place - 1.0, -landing_before);
      edge(find, depth, place, landing);
      float behind = max(depth, depth_before);
      if (landing_before < 0.0 && landing > 0.0 && behind > find.gap_depth) {
        find.gap_depth = behind;
        find.gap_place = depth > depth_before ? place : place - 1.0;
      }
    }
    if (i == last) edge(find, depth, place, -landing);
    depth_before = depth;
    landing_before = landing;
  }
  return find;
}

vec4 color_at(int layer, float place) {
  int left = int(floor(place)), last = textureSize(view_array, 0).x - 1, y = int(gl_FragCoord.y);
  vec4 a = texelFetch(view_array, ivec3(clamp(left, 0, last), y, layer), 0);
  vec4 b = texelFetch(view_array, ivec3(clamp(left + 1, 0, last), y, layer), 0);
  return mix(a, b, place - float(left));
}

void main() {
  Find a = search(key.x, shift.xy, reach.xy);
  if (a.depth < 2.0) {
    color = color_at(key.x, a.place);
    return;
  }
  Find b = search(key.y, shift.zw, reach.zw);
  if (b.depth < 2.0) color = color_at(key.y, b.place);
  else if (a.gap_depth >= 0.0) color = color_at(key.x, a.gap_place);
  else if (b.gap_depth >= 0.0) color = color_at(key.y, b.gap_place);
  else color = color_at(key.x, gl_FragCoord.x - 0.5);
}
