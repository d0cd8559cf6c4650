#version 450 core
// Tiles of all views: layer 0 at the lower left, then to the right, then upwards.

layout(binding = 0) uniform sampler2DArray view_array;  // sRGB-coded bytes
layout(location = 0) uniform ivec2 tile;                // pixels
layout(location = 1) uniform ivec2 count;               // columns, rows
layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 place = pixel / tile;
  bool padding = any(greaterThanEqual(place, count));
  ivec3 texel = ivec3(pixel - place * tile, padding ? 0 : place.y * count.x + place.x);
  color = padding ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(texelFetch(view_array, texel, 0).rgb, 1.0);
}
