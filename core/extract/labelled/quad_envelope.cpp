#include "core/extract/labelled/quad_envelope.h"

namespace dubsar {
namespace {

/// A corner seen along the edge: place across it, height along it.
struct EnvelopeCorner {
  std::int64_t u, v, height;
};

std::int64_t cross_of(const EnvelopeCorner& a, const EnvelopeCorner& b) { return a.u * b.v - a.v * b.u; }

}  // namespace

bool diagonal_in_envelope(const std::array<ExactPlace, 4>& corners, const ExactPlace& start, int axis,
                          bool first_diagonal) noexcept {
  const auto seen = [&](std::size_t i) {
    const ExactPlace d = corners[i % 4] - start;
    return EnvelopeCorner{d[(axis + 1) % 3], d[(axis + 2) % 3], d[axis]};
  };
  const std::size_t from = first_diagonal ? 0 : 1;
  const EnvelopeCorner a = seen(from), c = seen(from + 2);
  EnvelopeCorner near = seen(from + 1), far = seen(from + 3);  // far: beyond the diagonal, seen from the edge
  const std::int64_t ac = cross_of(a, c);
  if (ac == 0) {  // the diagonal meets the edge
    const std::int64_t da = std::abs(a.u) + std::abs(a.v), dc = std::abs(c.u) + std::abs(c.v);
    const std::int64_t height = a.height * dc + c.height * da;
    return height > 0 && height < kExactSteps * (da + dc);
  }
  const auto between = [&](const EnvelopeCorner& m) {
    return (cross_of(a, m) > 0) == (ac > 0) && (cross_of(m, c) > 0) == (ac > 0);
  };
  if (between(near)) std::swap(near, far);
  if (!between(far)) return false;

  // Where the triangle on the near side meets the axis of the edge.
  std::int64_t wa = cross_of(near, c), wn = -ac, wc = cross_of(a, near), sum = wa + wn + wc;
  std::int64_t height = wa * a.height + wn * near.height + wc * c.height;
  if (sum < 0) height = -height, sum = -sum;
  if (height <= 0 || height >= kExactSteps * sum) return false;

  // Where the diagonal meets the ray to the far corner: at t = ac / whole of it.
  std::int64_t to_a = cross_of(far, c), to_c = cross_of(a, far), whole = to_a + to_c, part = ac;
  if (whole < 0) to_a = -to_a, to_c = -to_c, whole = -whole, part = -part;
  if (part >= whole) return false;  // a reflex corner
  const std::int64_t there = to_a * a.height + to_c * c.height - part * far.height;
  return there > 0 && there < kExactSteps * (whole - part);
}

}  // namespace dubsar
