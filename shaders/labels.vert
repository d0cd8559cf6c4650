#version 450 core
// Letters of one line of text: four vertices a letter, all letters of a view after each other. The line begins at a place
// of the world and has a constant size in the picture. Whether it is seen goes by its place alone, so that a line is read
// as a whole or not at all: half a figure would be another one.

struct FlatView {
  mat4 view_from_world;
  mat4 clip_from_view;
  vec4 layer;  // x; y: 1 for parallel projection
};
struct Letter {
  vec4 place;  // pixels from the line's place, right and up: left, bottom, right, top
  vec4 sheet;  // the same corners in the sheet, 0..1
};
layout(std430, binding = 0) readonly buffer Views { FlatView views[]; };
layout(std430, binding = 1) readonly buffer Letters { Letter letters[]; };
layout(std430, binding = 2) readonly buffer Seen { uint seen[]; };  // of the squares of label_place.vert
layout(location = 0) uniform int count;
layout(location = 1) uniform vec3 measures;  // width and height of the target, lift in mm
layout(location = 2) uniform vec3 at;        // world
layout(location = 3) uniform vec3 along;     // world: where the line leads to; none: to the right of the picture
layout(location = 7) uniform ivec2 which;    // the label, of how many
layout(location = 8) uniform vec3 places;    // side of a square in pixels, opacity where hidden, 1: before what is nearer
layout(location = 9) uniform bool judged;    // one view has decided for all: its places were counted
layout(location = 10) uniform vec3 judge;    // width and height of its picture, side of a square
layout(location = 11) uniform mat4 clip_of_judge;

out vec2 sheet_place;
flat out float opacity;

// How much of the label is seen. Of one whose place is outside of the picture nobody knows: its letters go by their own
// depth.
float seen_at(vec2 place, vec3 picture, int view) {
  vec2 low = max(place - 0.5 * picture.z, vec2(0.0)), high = min(place + 0.5 * picture.z, picture.xy);
  vec2 size = high - low;
  if (min(size.x, size.y) < 1.0) return 1.0 - places.z;
  // Half a square is enough: so much is seen of a place on the outline.
  return min(1.0, 2.0 * float(seen[view * which.y + which.x]) / (size.x * size.y));
}

vec4 clip_position(FlatView view, vec3 point) {
  vec3 p = (view.view_from_world * vec4(point, 1.0)).xyz;
  vec3 to_eye = mix(normalize(-p), vec3(0.0, 0.0, 1.0), view.layer.y);
  return view.clip_from_view * vec4(p + measures.z * to_eye, 1.0);
}

void main() {
  FlatView view = views[gl_InstanceID / count];
  Letter letter = letters[gl_InstanceID % count];
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 offset = mix(letter.place.xy, letter.place.zw, corner);
  sheet_place = mix(letter.sheet.xy, letter.sheet.zw, corner);
  vec4 here = clip_position(view, at);
  vec2 half_size = 0.5 * measures.xy;
  vec4 looked = judged ? clip_of_judge * vec4(at, 1.0) : here;
  vec3 picture = judged ? judge : vec3(measures.xy, places.x);
  float seen_part = seen_at((looked.xy / looked.w + 1.0) * 0.5 * picture.xy, picture, judged ? 0 : gl_InstanceID / count);
  opacity = mix(places.y, 1.0, seen_part);
  if (here.z + here.w < 0.0 || here.w <= 0.0 || opacity <= 0.0) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  } else {
    vec2 right = vec2(1.0, 0.0);
    if (dot(along, along) > 0.0) {
      vec4 there = clip_position(view, at + along);
      vec2 way = (there.xy / there.w - here.xy / here.w) * half_size;
      if (there.w > 0.0 && dot(way, way) > 1.0) right = normalize(way);
    }
    vec2 turned = offset.x * right + offset.y * vec2(-right.y, right.x);
    gl_Position = vec4(here.xy + turned / half_size * here.w, here.zw);
  }
#ifdef LAYERED
  gl_Layer = int(view.layer.x);
#endif
}
