#version 450 core
// Ambient, diffuse and specular light (Blinn-Phong) in linear colours, or the vertex colours as they are, in one look
// or two. SHADOWED: the key light is cast (QUICK: with harder rims); PEELED: only what lies before the opaque and
// behind the peeled depths; INFERRED: hatched; FOGGY; BENT: radiance scaling; BLENDED: two looks;
// GLOWING: warm light around a line of sight; LIT, GLOSSY, KNEED: light.glsl.
#include "style.glsl"
#include "light.glsl"

layout(location = 1) uniform vec4 part_color;  // linear; a: opacity
layout(binding = 1) uniform sampler2DShadow shadow_map;
layout(binding = 2) uniform sampler2D opaque_depth;
layout(binding = 3) uniform sampler2D peeled_depth;

#ifdef GLOWING
flat in int view_of_vertex;
#endif
flat in float parallel;
in vec3 view_position;
in vec3 view_normal;
in vec3 albedo;
#ifdef BLENDED
in vec3 other_albedo;
#endif
#ifdef BENT
in float bend;
#else
const float bend = 0.0;
#endif
#ifdef SHADOWED
in vec3 map_position;
#endif
#ifdef INFERRED
in float stripe;
const bool kHatched = true;
#else
const bool kHatched = false;
#endif
#ifdef FILLED
in vec3 unit_place;
in vec3 way_to_eye;
in vec2 nearer;
#endif
layout(location = 0) out vec4 color;  // linear, premultiplied

/// How much of the key light comes here: 3 x 3 texels, each interpolated; where it has to be quick, one.
float lit_part() {
#ifdef SHADOWED
#ifdef QUICK
  return texture(shadow_map, map_position);
#else
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += texture(shadow_map, vec3(map_position.xy + vec2(x, y) * texel, map_position.z));
  return sum / 9.0;
#endif
#else
  return 1.0;
#endif
}

vec3 base_color(Look look, vec3 own, bool from_behind) {
#ifdef INFERRED
  return mix(inferred_color.rgb, inferred_stripe.rgb, step(0.5, fract(stripe))) * part_color.rgb;
#else
  return from_behind ? mix(own, look.back_color.rgb, look.back_color.a) : own;
#endif
}

vec3 way_from(vec3 position) {
  return mix(normalize(-position), vec3(0.0, 0.0, 1.0), parallel);
}

vec3 surface_color() {
  vec3 to_eye = way_from(view_position);
  // A small triangle that folds over, as coarse levels have them, belongs to the front that its normals tell of.
  bool from_behind = !gl_FrontFacing && dot(view_normal, to_eye) < 0.0;
  vec3 normal = normalize(view_normal);
  if (from_behind) normal = -normal;
  float open = dot(normal, looks[0].light.xyz) > 0.0 ? lit_part() : 1.0;
  vec3 seen = lit(looks[0], base_color(looks[0], albedo, from_behind), normal, to_eye, bend, open, kHatched);
#ifdef BLENDED
  vec3 other = lit(looks[1], base_color(looks[1], other_albedo, from_behind), normal, to_eye, bend, open, kHatched);
  seen = mix(seen, other, blend.x);
#endif
  return seen;
}

#ifdef GLOWING
const vec3 kWarm = vec3(0.69, 0.37, 0.053);

/// Most in its middle, nothing with no edge where it has faded; clay that is dark by itself glows, too.
vec3 glowing(vec3 seen) {
  vec2 aside = view_position.xy - (views[view_of_vertex].view_from_unit * vec4(glow.xyz, 1.0)).xy;
  float near = max(1.0 - dot(aside, aside) / (fog_depth.w * fog_depth.w), 0.0);
  return seen + glow.w * near * near * kWarm * (0.12 + 1.1 * seen);
}
#endif

#ifdef FILLED
const vec3 kSection = vec3(0.30, 0.19, 0.12), kSectionLine = vec3(0.10, 0.055, 0.03);  // burnt clay
#include "section.glsl"
#endif

void main() {
  float depth = gl_FragCoord.z;
#ifdef FILLED
  // Bodies that touch share their border: the inner side of the one and the outer side of the other lie at one place. A
  // line of sight leaves the nearer body there and goes on in the next, so that the inner side counts.
  bool inner = !gl_FrontFacing && (blend.z == 1.0 || dot(view_normal, way_from(view_position)) < 0.0);
  if (inner) depth = 0.5 * nearer.x / nearer.y + 0.5;
  gl_FragDepth = depth;
#endif
#ifdef PEELED
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (depth >= texelFetch(opaque_depth, pixel, 0).r || depth <= texelFetch(peeled_depth, pixel, 0).r) discard;
#endif
#ifdef FILLED
  // What is behind planes that lie behind the body is drawn as well: a closed surface whose inner side comes first says
  // that the line of sight came out of a plane inside of the body; its outer side, or nothing left: that there is none.
  float from, to;
  kept_part(unit_place, way_to_eye, from, to);
  if (from > 0.0 && (!inner || from >= to)) {
#ifdef PEELED
    discard;
#endif
    color = background;
    return;
  }
  if (inner && to < 1.0) {
    float line = step(0.72, fract(0.7 * dot(hatch.xyz, unit_place + to * way_to_eye)));
    color = vec4(mix(kSection, kSectionLine, line) * part_color.rgb, 1.0) * part_color.a;
    return;
  }
#endif
  color = vec4(surface_color(), 1.0);
#ifdef GLOWING
  color.rgb = glowing(color.rgb);
#endif
#ifdef FOGGY
  float far = clamp((-view_position.z - fog_depth.x) / (fog_depth.y - fog_depth.x), 0.0, 1.0);
  color = mix(color, fog_color, far * fog_depth.z);
#endif
  color *= part_color.a;
}
