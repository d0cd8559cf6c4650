#version 450 core
// One vertex of the surface: position in the unit cube of the mesh, packed attributes, octahedral normal. With LAYERED
// each instance draws one view into its own layer; with CLIPPED planes cut. SHADOWED, PEELED, INFERRED
// and FOGGY are switches of the fragment shader, too.

layout(location = 0) in vec3 unit_position;
layout(location = 1) in uint packed_attributes;  // shape 7 bits, ambient light 6 bits, partition 3 bits
layout(location = 2) in vec2 oct_normal;
layout(location = 3) in vec4 foreign_color;  // sRGB-coded; (1, 1, 1) when the mesh has none

struct ViewData {
  mat4 view_from_unit;
  mat4 clip_from_view;
  mat4 view_from_normal;  // rotation; [3][3] is 1 for parallel projection, [3][0] the layer
};
layout(std430, binding = 0) readonly buffer Views { ViewData views[]; };
layout(location = 0) uniform int view_index;
layout(location = 1) uniform vec4 part_color;   // linear; a: opacity
layout(location = 2) uniform vec3 part_offset;  // in the unit cube

layout(std140, binding = 1) uniform Style {
  vec4 light;            // xyz: unit direction to the key light in the view frame; w: 1 = lit
  vec4 weights;          // ambient, key, fill (from the eye), specular
  vec4 back_color;       // linear; a: how much of it back faces take
  vec4 shininess;        // x; y: linear light from which on highlights bend
  vec4 inferred_color;   // linear
  vec4 inferred_stripe;  // linear
  vec4 hatch;            // stripes along the axes of the unit cube
  vec4 fog_color;        // linear, premultiplied
  vec4 fog_depth;        // from, to, how much at most
  mat4 map_from_unit;    // shadow map: texture coordinates and depth
  mat4 map_from_normal;  // of the offset along the normal
  vec4 clip_plane[8];    // in the unit cube; what is below 0 goes
};
layout(binding = 0) uniform sampler2D color_table;  // linear, x: shape, y: ambient light

flat out int view_of_vertex;
out vec3 view_position;
out vec3 view_normal;
out vec3 albedo;  // linear
#ifdef SHADOWED
out vec3 map_position;
#endif
#ifdef INFERRED
out float stripe;
#endif
#ifdef CLIPPED
out float gl_ClipDistance[8];
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

void main() {
#ifdef LAYERED
  view_of_vertex = gl_InstanceID;
#else
  view_of_vertex = view_index;
#endif
  ViewData view = views[view_of_vertex];
  uint shape = packed_attributes & 127u;
  uint ao = (packed_attributes >> 7) & 63u;

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
  albedo = texelFetch(color_table, ivec2(shape, ao), 0).rgb * linear_from_srgb(foreign_color.rgb) * part_color.rgb;
  gl_Position = view.clip_from_view * position;
#ifdef CLIPPED
  for (int i = 0; i < 8; ++i) gl_ClipDistance[i] = dot(clip_plane[i], unit);
#endif
#ifdef LAYERED
  gl_Layer = int(view.view_from_normal[3][0]);
#endif
}
