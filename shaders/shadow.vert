#version 450 core
// A vertex of a surface as the light sees it.

layout(location = 0) in vec3 unit_position;
layout(location = 0) uniform mat4 clip_from_unit;
layout(location = 1) uniform vec3 part_offset;
layout(location = 2) uniform int clips;
layout(location = 3) uniform vec4 clip_plane[8];  // in the unit cube; what is below 0 goes
out float gl_ClipDistance[8];

void main() {
  vec4 unit = vec4(unit_position + part_offset, 1.0);
  gl_Position = clip_from_unit * unit;
  for (int i = 0; i < 8; ++i) gl_ClipDistance[i] = i < clips ? dot(clip_plane[i], unit) : 1.0;
}
