#version 450 core
// A rectangle in the world, one instance a view.

struct FlatView {
  mat4 view_from_world;
  mat4 clip_from_view;
  vec4 layer;  // x; y: 1 for parallel projection
};
layout(std430, binding = 0) readonly buffer Views { FlatView views[]; };
layout(location = 0) uniform vec3 corner;
layout(location = 1) uniform vec3 across;
layout(location = 2) uniform vec3 along;

out vec2 place;  // 0..1 in the image
out vec3 world_position;

void main() {
  FlatView view = views[gl_InstanceID];
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  world_position = corner + place.x * across + place.y * along;
  gl_Position = view.clip_from_view * (view.view_from_world * vec4(world_position, 1.0));
#ifdef LAYERED
  gl_Layer = int(view.layer.x);
#endif
}
