// Looks at the model itself, without a scan: phantom_view PRESET SEED SIDE tablet|outer|all|wall PIXELS > picture.ppm
// An orthographic picture shaded by three lamps, found by sphere tracing.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/phantom/phantom.h"

using namespace dubsar;
using namespace dubsar::phantom;

int main(int argc, char** argv) {
  if (argc < 6) return 64;
  auto options = parse_preset(argv[1]);
  if (!options) return 64;
  options->seed = std::strtoull(argv[2], nullptr, 10);
  const auto side = static_cast<Side>(std::atoi(argv[3]));
  const std::string what = argv[4];
  const int pixels = std::atoi(argv[5]);
  const double zoom = argc > 6 ? std::atof(argv[6]) : 1.0;
  const auto phantom = Phantom::create(*options).value();
  int open = 0, tablet_wedges = 0;
  for (const Wedge& w : phantom->wedges())
    if (w.owner == Owner::kTablet) ++tablet_wedges, open += w.open;
  fmt::print(stderr, "wedges {} (tablet {}, open {}), glued {:.3f}, pores {}, crack {}, voxel {:.4f} mm\n",
             phantom->wedges().size(), tablet_wedges, open, phantom->glued_fraction(), phantom->pore_count(),
             phantom->cracked(), phantom->options().voxel_mm);
  const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
  const auto axis = [](SignedAxis a) {
    glm::dvec3 v(0.0);
    v[a.axis] = static_cast<double>(a.sign);
    return v;
  };
  const glm::dvec3 right = axis(frame.right), up = axis(frame.up), normal = axis(frame.normal);
  const Dims d = phantom->options().dims;
  const glm::dvec3 size(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z)),
      centre = 0.5 * size;
  const double width = std::abs(glm::dot(right, size)) / zoom, height = std::abs(glm::dot(up, size)) / zoom;
  const double step = width / pixels;
  const int rows = static_cast<int>(height / step);
  const auto field = [&](const glm::dvec3& p) {
    const Fields f = phantom->fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    return what == "tablet" ? f.tablet : what == "outer" ? f.outer : what == "wall" ? -f.wall : f.clay;
  };
  std::vector<unsigned char> picture(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(rows) * 3);
  parallel_for(rows, 4, [&](std::int64_t row) {
    for (int column = 0; column < pixels; ++column) {
      glm::dvec3 p = centre + right * ((column + 0.5) * step - 0.5 * width) +
                     up * (0.5 * height - (static_cast<double>(row) + 0.5) * step) +
                     normal * (std::abs(glm::dot(normal, size)) * 0.6);
      const double end = glm::dot(p, normal) - std::abs(glm::dot(normal, size)) * 1.2;
      bool hit = false;
      Dual f;
      for (int i = 0; i < 400 && glm::dot(p, normal) > end; ++i) {
        f = field(p);
        if (f.v < 0.01f) {
          hit = true;
          break;
        }
        p -= normal * std::clamp(static_cast<double>(f.v) * 0.55, 0.01, 20.0);
      }
      double light = 0.16;
      if (hit) {
        const auto value = [&](const glm::dvec3& q) { return static_cast<double>(field(q).v); };
        const double e = 0.3;
        const glm::dvec3 n =
            glm::normalize(glm::dvec3(value(p + glm::dvec3(e, 0, 0)) - value(p - glm::dvec3(e, 0, 0)),
                                      value(p + glm::dvec3(0, e, 0)) - value(p - glm::dvec3(0, e, 0)),
                                      value(p + glm::dvec3(0, 0, e)) - value(p - glm::dvec3(0, 0, e))));
        const glm::dvec3 key = glm::normalize(-right * 1.0 + up * 1.0 + normal * 0.9),
                         fill = glm::normalize(right + normal);
        light = 0.10 + 0.75 * std::max(0.0, glm::dot(n, key)) + 0.15 * std::max(0.0, glm::dot(n, fill));
      }
      unsigned char* out = &picture[(static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels) +
                                     static_cast<std::size_t>(column)) *
                                    3];
      const double tint[3] = {1.0, 0.86, 0.70};
      for (int c = 0; c < 3; ++c)
        out[c] = static_cast<unsigned char>(255.0 * std::min(1.0, light * (hit ? tint[c] : 1.0)));
    }
  });
  std::printf("P6\n%d %d\n255\n", pixels, rows);
  std::fwrite(picture.data(), 1, picture.size(), stdout);
  return 0;
}
