#version 450 core
// Letters from distances to their outlines, with a border.

layout(binding = 0) uniform sampler2D sheet;  // 0.5 on the outline, more inside
layout(location = 4) uniform vec4 fill;       // linear, premultiplied
layout(location = 5) uniform vec4 border;     // linear, premultiplied
layout(location = 6) uniform float wide;      // of the border, in the sheet's units
layout(location = 12) uniform float plate;    // how much the ground of the text covers

in vec2 sheet_place;
flat in float opacity;
layout(location = 0) out vec4 color;  // linear, premultiplied

void main() {
  if (sheet_place.x < 0.0) {  // the ground, which is no letter
    color = border * plate * opacity;
    return;
  }
  float inside = texture(sheet, sheet_place).r - 0.5;
  float soft = max(0.7 * fwidth(inside), 1e-4);
  float letter = smoothstep(-soft, soft, inside);
  float around = smoothstep(-soft, soft, inside + wide);
  color = mix(border * around, fill, letter) * opacity;
  if (color.a == 0.0) discard;
}
