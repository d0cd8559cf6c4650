#version 450 core
// Grey values of the scan between black and white.

layout(binding = 0) uniform sampler2D slice_values;
layout(location = 3) uniform vec3 window;  // black, white, opacity
layout(location = 4) uniform int clips;
layout(location = 5) uniform vec4 clip_plane[8];

in vec2 place;
in vec3 world_position;
layout(location = 0) out vec4 color;  // linear, premultiplied

void main() {
  for (int i = 0; i < clips; ++i)
    if (dot(clip_plane[i], vec4(world_position, 1.0)) < 0.0) discard;
  float range = window.y - window.x;
  float grey = texture(slice_values, place).r - window.x;
  float coded = range == 0.0 ? step(0.0, grey) : clamp(grey / range, 0.0, 1.0);
  float light = coded <= 0.04045 ? coded / 12.92 : pow((coded + 0.055) / 1.055, 2.4);
  color = vec4(vec3(light), 1.0) * window.z;
}
