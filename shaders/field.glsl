// Figures of the surface that colours tell, from what a vertex carries of them; display/render/mesh/surface_field.h has the
// same in C++.

const float kMostDistance = 0.5, kMostCurvature = 32.0, kMostApart = 2.0;  // what 1 stands for

/// 1 distance of integral invariants from a plane, 2 mean, 3 Gaussian curvature, 4 shape index, 5 curvedness, 6 difference
/// from another surface.
float field_figure(int which, vec4 carried) {
  float low = kMostCurvature * carried.y, high = kMostCurvature * carried.z;
  if (which == 1) return kMostDistance * carried.x;
  if (which == 2) return 0.5 * (low + high);
  if (which == 3) return low * high;
  if (which == 4) return low == 0.0 && high == 0.0 ? 0.0 : atan(low + high, high - low) / 1.57079633;
  if (which == 6) return kMostApart * carried.w;
  return sqrt(0.5 * (low * low + high * high));
}

/// A difference that there is none of: nothing of the other surface lies here.
bool not_compared(int which, vec4 carried) { return which == 6 && carried.w < -0.99999; }

/// Bend of the surface for radiance scaling: convex above 0, without bounds on what may be sharp.
float bend_of(vec4 carried) { return 2.5 * tanh(0.25 * kMostCurvature * (carried.y + carried.z)); }
