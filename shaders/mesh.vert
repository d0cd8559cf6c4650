#version 450 core
// One vertex of the surface: position in the unit cube of the mesh, packed attributes, octahedral normal. With LAYERED
// each instance draws one view into its own layer; with CLIPPED planes cut. The other switches are those of the
// fragment shader, too.
#include "style.glsl"
#include "field.glsl"

layout(location = 0) in vec3 unit_position;
layout(location = 1) in uint packed_attributes;  // shape 7 bits, ambient light 6 bits, partition 3 bits
layout(location = 2) in vec2 oct_normal;
layout(location = 3) in vec4 foreign_color;  // sRGB-coded; (1, 1, 1) when the mesh has none
layout(location = 4) in vec4 carried;        // figures of the surface (field.glsl); 0 while nobody asks for them

layout(location = 0) uniform int view_index;
layout(location = 1) uniform vec4 part_color;   // linear; a: opacity
layout(location = 2) uniform vec3 part_offset;  // in the unit cube
layout(binding = 0) uniform sampler2D color_table;  // linear, x: shape or figure, y: ambient light
layout(binding = 4) uniform sampler2D other_table;

#ifdef GLOWING
flat out int view_of_vertex;
#endif
flat out float parallel;
out vec3 view_position;
out vec3 view_normal;
out vec3 albedo;  // linear
#ifdef BLENDED
out vec3 other_albedo;
#endif
#ifdef BENT
out float bend;
#endif
#ifdef SHADOWED
out vec3 map_position;
#endif
#ifdef INFERRED
out float stripe;
#endif
#ifdef CLIPPED
out float gl_ClipDistance[8];
#endif
#ifdef FILLED
out vec3 unit_place;
out vec3 way_to_eye;  // in the unit cube; of parallel projections longer than it
out vec2 nearer;      // z and w of the clip space, a little nearer to the eye
#endif

vec3 linear_from_srgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 decode_octahedral(vec2 e) {
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.xy -= vec2(n.x >= 0.0 ? t : -t, n.y >= 0.0 ? t : -t);
  return normalize(n);
}

vec3 table_color(sampler2D table, Look look) {
  int ao = int((packed_attributes >> 7) & 63u);
  if (look.field.x == 0.0) return texelFetch(table, ivec2(packed_attributes & 127u, ao), 0).rgb;
  if (not_compared(int(look.field.x), carried)) return vec3(0.2158605);  // 128 of sRGB, as difference_color()
  float at = 127.0 * clamp(field_figure(int(look.field.x), carried) * look.field.y + look.field.z, 0.0, 1.0);
  int low = int(at);
  return mix(texelFetch(table, ivec2(low, ao), 0).rgb, texelFetch(table, ivec2(min(low + 1, 127), ao), 0).rgb,
             at - float(low));
}

void main() {
#ifdef LAYERED
  ViewData view = views[gl_InstanceID];
#else
  ViewData view = views[view_index];
#endif
  parallel = view.view_from_normal[3][3];
#ifdef GLOWING
#ifdef LAYERED
  view_of_vertex = gl_InstanceID;
#else
  view_of_vertex = view_index;
#endif
#endif
  vec4 unit = vec4(unit_position + part_offset, 1.0);
  vec4 position = view.view_from_unit * unit;
  view_position = position.xyz;
  vec3 normal = decode_octahedral(oct_normal);
  view_normal = mat3(view.view_from_normal) * normal;
#ifdef SHADOWED
  map_position = (map_from_unit * unit).xyz + mat3(map_from_normal) * normal;
#endif
#ifdef INFERRED
  stripe = dot(hatch.xyz, unit_position);
#endif
#ifdef BENT
  bend = bend_of(carried);
#endif
  vec3 own = linear_from_srgb(foreign_color.rgb) * part_color.rgb;
  albedo = table_color(color_table, looks[0]) * own;
#ifdef BLENDED
  other_albedo = table_color(other_table, looks[1]) * own;
#endif
  gl_Position = view.clip_from_view * position;
#ifdef FILLED
  unit_place = unit.xyz;
  mat4 unit_from_view = inverse(view.view_from_unit);
  way_to_eye = view.view_from_normal[3][3] == 1.0
                   ? unit_from_view[2].xyz * 4.0 / max(length(unit_from_view[2].xyz), 1e-9)
                   : unit_from_view[3].xyz - unit.xyz;
  nearer = (view.clip_from_view * (position + vec4(0.0, 0.0, blend.y, 0.0))).zw;
#endif
#ifdef CLIPPED
  for (int i = 0; i < 8; ++i) {
    gl_ClipDistance[i] = dot(clip_plane[i], unit);
#ifdef FILLED
    // Planes behind the body: the fragment shader looks after them.
    if (dot(clip_plane[i], vec4(unit.xyz + way_to_eye, 1.0)) >= 0.0) gl_ClipDistance[i] = 1.0;
#endif
  }
#endif
#ifdef LAYERED
  gl_Layer = int(view.view_from_normal[3][0]);
#endif
}
