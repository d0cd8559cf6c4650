#version 450 core
// A round glass over a view, or the ring that a pointer leaves on the surface, each within a square of the picture.

layout(binding = 0) uniform sampler2DArray pictures;  // what the glass shows, coded
layout(location = 0) uniform int layer;
layout(location = 1) uniform vec3 place;  // lower left corner and side, pixels
layout(location = 2) uniform int ring;    // 1: no picture
layout(location = 0) out vec4 color;

const vec3 kAmber = vec3(0.851, 0.643, 0.255), kDark = vec3(0.09, 0.094, 0.106);

void main() {
  vec2 at = (gl_FragCoord.xy - place.xy) / place.z;
  float r = 2.0 * length(at - 0.5);
  if (r > 1.0) discard;
  if (ring != 0) {
    if (r < 0.5 && r > 0.2) discard;
    color = vec4(r > 0.85 || (r < 0.62 && r > 0.2) ? kDark : kAmber, 1.0);
    return;
  }
  float rim = 4.0 / place.z;
  color = vec4(r > 1.0 - rim ? kDark : r > 1.0 - 3.0 * rim ? kAmber : texture(pictures, vec3(at, layer)).rgb, 1.0);
}
