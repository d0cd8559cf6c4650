// What planes leave of bodies, as one line of sight goes through it.

/// How the line from `place` on a surface to the eye goes: with `way` = 1 at the eye, it comes into what the planes
/// keep at `from` and goes out of it, to the eye, at `to`; 1: it stays in.
void kept_part(vec3 place, vec3 way, out float from, out float to) {
  from = 0.0;
  to = 1.0;
  for (int i = 0; i < 8; ++i) {
    float slope = dot(clip_plane[i].xyz, way), here = dot(clip_plane[i], vec4(place, 1.0));
    if (slope < 0.0) to = min(to, -here / slope);
    if (slope > 0.0 && here < 0.0) from = max(from, -here / slope);
  }
}
