#version 450 core
// A small square over the place of each label in each view: four vertices a square, all places of a view after each
// other. Its fragments that nothing hides are counted (label_place.frag).

struct FlatView {
  mat4 view_from_world;
  mat4 clip_from_view;
  vec4 layer;  // x; y: 1 for parallel projection
};
layout(std430, binding = 0) readonly buffer Views { FlatView views[]; };
layout(std430, binding = 1) readonly buffer Places { vec4 places[]; };  // world; w: lift in mm
layout(location = 0) uniform int count;
layout(location = 1) uniform vec3 measures;  // width and height of the target, side of a square: pixels

flat out int counted;

void main() {
  FlatView view = views[gl_InstanceID / count];
  vec4 place = places[gl_InstanceID % count];
  counted = gl_InstanceID;
  vec3 p = (view.view_from_world * vec4(place.xyz, 1.0)).xyz;
  vec3 to_eye = mix(normalize(-p), vec3(0.0, 0.0, 1.0), view.layer.y);
  vec4 here = view.clip_from_view * vec4(p + place.w * to_eye, 1.0);
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) - 0.5;
  gl_Position = here.z + here.w < 0.0 || here.w <= 0.0
                    ? vec4(0.0, 0.0, 2.0, 1.0)
                    : vec4(here.xy + corner * measures.z * 2.0 / measures.xy * here.w, here.zw);
#ifdef LAYERED
  gl_Layer = int(view.layer.x);
#endif
}
