// naive_visitors [SEED [OF_EACH_KIND [why]]]: people who were never told before the kiosk, and its figures.

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "tests/app/kiosk/gallery_visit.h"

int main(int argc, char** argv) {
  using namespace dubsar;
  using namespace dubsar::app::test;
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const int each = argc > 2 ? std::atoi(argv[2]) : 100;
  const bool why = argc > 3 && std::string_view(argv[3]) == "why";
  constexpr std::array<std::string_view, 5> kNames{"waves", "pokes", "pushes", "grabs far", "imitates"};
  GalleryFigures all;
  fmt::print("{:<10} {:>8} {:>10} {:>8} {:>10} {:>13} {:>11}\n", "kind", "visitors", "turn 20 s", "zoom", "open 60 s",
             "unwanted/min", "bystanders");
  const auto print = [](std::string_view name, const GalleryFigures& f) {
    const auto percent = [&](int n) { return 100.0 * n / f.visitors; };
    fmt::print("{:<10} {:>8} {:>8.1f} % {:>6.1f} % {:>8.1f} % {:>13.3f} {:>11}\n", name, f.visitors, percent(f.turned),
               percent(f.zoomed), percent(f.opened), f.unwanted / f.minutes, f.takeovers);
  };
  for (std::size_t kind = 0; kind < kNaiveKinds.size(); ++kind) {
    GalleryFigures figures;
    for (int i = 0; i < each; ++i) {
      const auto one = draw_gallery(kNaiveKinds[kind], seed + 1000 * kind + static_cast<unsigned>(i));
      const GalleryVisit seen = visit(one);
      figures.add(seen);
      all.add(seen);
      if (why)
        fmt::print("{} {}: turned {:.1f} zoomed {:.1f} opened {:.1f}\n{}", kNames[kind], one.seed,
                   seen.turned_s.value_or(-1), seen.zoomed_s.value_or(-1), seen.opened_s.value_or(-1), seen.causes);
    }
    print(kNames[kind], figures);
  }
  print("all", all);
}
