#version 450 core
// Segments as quads of constant width in the picture: four vertices a segment, all segments of a view after each other.

struct FlatView {
  mat4 view_from_world;
  mat4 clip_from_view;
  vec4 layer;  // x; y: 1 for parallel projection
};
layout(std430, binding = 0) readonly buffer Views { FlatView views[]; };
layout(std430, binding = 1) readonly buffer Points { vec4 points[]; };  // world
layout(location = 0) uniform int segments;
layout(location = 1) uniform vec4 measures;  // width and height of the target, half a line's width, lift in mm

const float kNearest = 1e-4;  // clip w of the near plane's side, relative to the other end

vec4 clip_position(FlatView view, vec3 point) {
  vec3 p = (view.view_from_world * vec4(point, 1.0)).xyz;
  vec3 to_eye = mix(normalize(-p), vec3(0.0, 0.0, 1.0), view.layer.y);
  return view.clip_from_view * vec4(p + measures.w * to_eye, 1.0);
}

void main() {
  FlatView view = views[gl_InstanceID / segments];
  int first = 2 * (gl_InstanceID % segments);
  vec4 a = clip_position(view, points[first].xyz), b = clip_position(view, points[first + 1].xyz);
  // The part behind the near plane has no place in the picture: it is cut off here, before the division.
  float near_a = a.z + a.w, near_b = b.z + b.w;
  if (near_a < 0.0 && near_b < 0.0) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  } else {
    vec4 start = near_a < 0.0 ? mix(b, a, near_b / (near_b - near_a) * (1.0 - kNearest)) : a;
    vec4 end = near_b < 0.0 ? mix(a, b, near_a / (near_a - near_b) * (1.0 - kNearest)) : b;
    vec2 half_size = 0.5 * measures.xy;
    vec2 direction = end.xy / end.w * half_size - start.xy / start.w * half_size;
    direction = dot(direction, direction) > 1e-12 ? normalize(direction) : vec2(1.0, 0.0);
    bool at_end = (gl_VertexID & 1) == 1;
    vec4 here = at_end ? end : start;
    vec2 offset = measures.z * (vec2(-direction.y, direction.x) * ((gl_VertexID >> 1) == 1 ? 1.0 : -1.0) +
                                direction * (at_end ? 1.0 : -1.0));
    gl_Position = vec4(here.xy + offset / half_size * here.w, here.zw);
  }
#ifdef LAYERED
  gl_Layer = int(view.layer.x);
#endif
}
