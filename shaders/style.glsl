// What the shaders of surfaces read: the views, and one or two looks of the surface.

struct ViewData {
  mat4 view_from_unit;
  mat4 clip_from_view;
  mat4 view_from_normal;  // rotation; [3][3] is 1 for parallel projection, [3][0] the layer
};
layout(std430, binding = 0) readonly buffer Views { ViewData views[]; };

struct Look {
  vec4 light;       // xyz: unit direction to the key light in the view frame; w: 1 = lit
  vec4 weights;     // ambient, key, fill (from the eye), specular
  vec4 back_color;  // linear; a: how much of it back faces take
  vec4 gloss;       // shininess; linear light from which on highlights bend; radiance scaling; how much shadows count
  vec4 field;       // x: which figure of the surface the colours tell, 0 its shape class; y, z: figure * y + z is 0..1
};
layout(std140, binding = 1) uniform Style {
  Look looks[2];
  vec4 blend;            // x: share of the second look; y: of sections, how much nearer inner sides count, view's mm;
                         // z: 1 where no triangle folds over
  vec4 inferred_color;   // linear
  vec4 inferred_stripe;  // linear
  vec4 hatch;            // stripes along the axes of the unit cube
  vec4 fog_color;        // linear, premultiplied
  vec4 background;       // linear, premultiplied
  vec4 fog_depth;        // from, to, how much at most; w: of the glow, where it has faded, mm
  vec4 glow;             // place in the unit cube, strength
  mat4 map_from_unit;    // shadow map: texture coordinates and depth
  mat4 map_from_normal;  // of the offset along the normal
  vec4 clip_plane[8];    // in the unit cube; what is below 0 goes
};
