// How light becomes brightness. What no look of a picture has is left out, since without a GPU both sides of a branch
// cost time: light (LIT), highlights (GLOSSY), a knee (KNEED), radiance scaling (BENT).

const float kLeastInferredLight = 0.35;
#ifdef LIT
const bool kLit = true;
#else
const bool kLit = false;
#endif
#ifdef GLOSSY
const bool kGlossy = true;
#else
const bool kGlossy = false;
#endif
#ifdef KNEED
const bool kKneed = true;
#else
const bool kKneed = false;
#endif
#ifdef BENT
const bool kBent = true;
#else
const bool kBent = false;
#endif
const float kInvariant = 0.2;  // the reflected light that radiance scaling leaves as it is

/// Linear up to the knee, then towards white without reaching it.
vec3 bent(vec3 light, float knee) {
  if (knee >= 1.0) return light;
  vec3 above = max(light - knee, 0.0);
  return min(light, vec3(knee)) + (1.0 - knee) * (1.0 - exp(-above / (1.0 - knee)));
}

/// Times this is reflected light where the surface is bent: more on ridges, less in hollows, the other way round where
/// it is darker than kInvariant (R. Vergne, R. Pacanowski, P. Barla, X. Granier, C. Schlick: Radiance scaling for
/// versatile surface enhancement, 2010, equation 2, convex counted as negative).
float radiance_scale(float bend, float reflected) {
  float e = exp(-bend);
  float a = kInvariant;
  return (a * e + reflected * (1.0 - a - a * e)) / (a + reflected * (e - a - a * e));
}

/// A surface of this colour, normal and bend (0: flat) under a look's light, as much of which comes here as `open`
/// says; `hatched` is never dark.
vec3 lit(Look look, vec3 base, vec3 normal, vec3 to_eye, float bend, float open, bool hatched) {
  float fill = max(dot(normal, to_eye), 0.0);
  float more = kBent ? look.gloss.z : 0.0;
  if (!kLit || look.light.w == 0.0) return more > 0.0 ? base * radiance_scale(more * bend, fill) : base;
  float key = max(dot(normal, look.light.xyz), 0.0);
  float gloss = 0.0;
  if (kGlossy && key > 0.0) gloss = pow(max(dot(normal, normalize(look.light.xyz + to_eye)), 0.0), look.gloss.x);
  if (more > 0.0) {
    key *= radiance_scale(more * bend, key);
    fill *= radiance_scale(more * bend, fill);
  }
  float comes = mix(1.0, open, look.gloss.w);
  float level = look.weights.x + look.weights.y * key * comes + look.weights.z * fill;
  if (hatched) level = max(level, kLeastInferredLight);
  vec3 light = base * level + vec3(look.weights.w * gloss * comes);
  return kKneed ? bent(light, look.gloss.y) : light;
}
