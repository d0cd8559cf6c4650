#version 450 core
// Ambient, diffuse and specular light (Blinn-Phong) in linear colours, or the vertex colours as they are. SHADOWED: the
// key light is cast; PEELED: only what lies before the opaque and behind the peeled depths; INFERRED: hatched; FOGGY.

struct ViewData {
  mat4 view_from_unit;
  mat4 clip_from_view;
  mat4 view_from_normal;
};
layout(std430, binding = 0) readonly buffer Views { ViewData views[]; };
layout(location = 1) uniform vec4 part_color;  // linear; a: opacity

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
layout(binding = 1) uniform sampler2DShadow shadow_map;
layout(binding = 2) uniform sampler2D opaque_depth;
layout(binding = 3) uniform sampler2D peeled_depth;

flat in int view_of_vertex;
in vec3 view_position;
in vec3 view_normal;
in vec3 albedo;
#ifdef SHADOWED
in vec3 map_position;
#endif
#ifdef INFERRED
in float stripe;
#endif
layout(location = 0) out vec4 color;  // linear, premultiplied

const float kLeastInferredLight = 0.35;

/// How much of the key light comes here: 3 x 3 texels, each interpolated.
float lit_part() {
#ifdef SHADOWED
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += texture(shadow_map, vec3(map_position.xy + vec2(x, y) * texel, map_position.z));
  return sum / 9.0;
#else
  return 1.0;
#endif
}

/// Linear up to the knee, then towards white without reaching it.
vec3 bent(vec3 light) {
  float knee = shininess.y;
  if (knee >= 1.0) return light;
  vec3 above = max(light - knee, 0.0);
  return min(light, vec3(knee)) + (1.0 - knee) * (1.0 - exp(-above / (1.0 - knee)));
}

vec3 surface_color() {
  vec3 to_eye = mix(normalize(-view_position), vec3(0.0, 0.0, 1.0), views[view_of_vertex].view_from_normal[3][3]);
  // A small triangle that folds over, as coarse levels have them, belongs to the front that its normals tell of.
  bool from_behind = !gl_FrontFacing && dot(view_normal, to_eye) < 0.0;
#ifdef INFERRED
  vec3 base = mix(inferred_color.rgb, inferred_stripe.rgb, step(0.5, fract(stripe))) * part_color.rgb;
#else
  vec3 base = from_behind ? mix(albedo, back_color.rgb, back_color.a) : albedo;
#endif
  if (light.w == 0.0) return base;
  vec3 normal = normalize(view_normal);
  if (from_behind) normal = -normal;
  float key = max(dot(normal, light.xyz), 0.0);
  float fill = max(dot(normal, to_eye), 0.0);
  float gloss = key > 0.0 ? pow(max(dot(normal, normalize(light.xyz + to_eye)), 0.0), shininess.x) : 0.0;
  float open = key > 0.0 ? lit_part() : 1.0;
  float level = weights.x + weights.y * key * open + weights.z * fill;
#ifdef INFERRED
  level = max(level, kLeastInferredLight);
#endif
  return bent(base * level + vec3(weights.w * gloss * open));
}

void main() {
#ifdef PEELED
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (gl_FragCoord.z >= texelFetch(opaque_depth, pixel, 0).r || gl_FragCoord.z <= texelFetch(peeled_depth, pixel, 0).r)
    discard;
#endif
  color = vec4(surface_color(), 1.0);
#ifdef FOGGY
  float far = clamp((-view_position.z - fog_depth.x) / (fog_depth.y - fog_depth.x), 0.0, 1.0);
  color = mix(color, fog_color, far * fog_depth.z);
#endif
  color *= part_color.a;
}
