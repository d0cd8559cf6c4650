#version 450 core
// Ambient, diffuse and specular light (Blinn-Phong) in linear colours, or the vertex colours as they are.

struct ViewData {
  mat4 view_from_unit;
  mat4 clip_from_view;
  mat4 view_from_normal;
};
layout(std430, binding = 0) readonly buffer Views { ViewData views[]; };

layout(std140, binding = 1) uniform Style {
  vec4 light;
  vec4 weights;
  vec4 back_color;
  vec4 shininess;
  vec4 clip_plane[8];
};

flat in int view_of_vertex;
in vec3 view_position;
in vec3 view_normal;
in vec3 albedo;
layout(location = 0) out vec4 color;  // linear, premultiplied

void main() {
  vec3 to_eye = mix(normalize(-view_position), vec3(0.0, 0.0, 1.0), views[view_of_vertex].view_from_normal[3][3]);
  // A small triangle that folds over, as coarse levels have them, belongs to the front that its normals tell of.
  bool from_behind = !gl_FrontFacing && dot(view_normal, to_eye) < 0.0;
  vec3 base = from_behind ? mix(albedo, back_color.rgb, back_color.a) : albedo;
  if (light.w == 0.0) {
    color = vec4(base, 1.0);
    return;
  }
  vec3 normal = normalize(view_normal);
  if (from_behind) normal = -normal;
  float key = max(dot(normal, light.xyz), 0.0);
  float fill = max(dot(normal, to_eye), 0.0);
  float gloss = key > 0.0 ? pow(max(dot(normal, normalize(light.xyz + to_eye)), 0.0), shininess.x) : 0.0;
  color = vec4(base * (weights.x + weights.y * key + weights.z * fill) + vec3(weights.w * gloss), 1.0);
}
