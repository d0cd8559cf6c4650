// naive_visitors [SEED [OF_EACH_KIND [why] [HZ] [MAPPING.json]]]: people who were never told before the kiosk, and its
// figures; HZ: of their hand tracker.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#include "core/base/files/atomic_file.h"
#include "tests/app/kiosk/gallery_session.h"
#include "tests/app/kiosk/gallery_visit.h"

int main(int argc, char** argv) {
  using namespace dubsar;
  using namespace dubsar::app::test;
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const int each = argc > 2 ? std::atoi(argv[2]) : 100;
  bool why = false;
  double rate_hz = 0.0;
  for (int i = 3; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "why") {
      why = true;
    } else if (word.ends_with(".json")) {
      const auto text = read_text_file(argv[i]);
      const auto mapping = text ? parse_mapping(*text, argv[i]) : Result<Mapping>(tl::unexpected<Error>(text.error()));
      if (!mapping) {
        fmt::print(stderr, "{}\n", mapping.error().message);
        return exit_code(mapping.error().kind);
      }
      GallerySession::set_mapping(*mapping);
    } else {
      rate_hz = std::atof(argv[i]);
    }
  }
  constexpr std::array<std::string_view, 5> kNames{"waves", "pokes", "pushes", "grabs far", "imitates"};
  GalleryFigures all;
  struct Tries {
    int count = 0, seen = 0, kept = 0, held = 0, moved = 0, meant = 0;
  };
  std::map<std::string, Tries> tries;
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
      auto one = draw_gallery(kNaiveKinds[kind], seed + 1000 * kind + static_cast<unsigned>(i));
      one.rate_hz = rate_hz;
      const GalleryVisit seen = visit(one);
      figures.add(seen);
      all.add(seen);
      if (why)
        fmt::print("{} {}: turned {:.1f} zoomed {:.1f} opened {:.1f}, {} others, camera {}\n{}", kNames[kind], one.seed,
                   seen.turned_s.value_or(-1), seen.zoomed_s.value_or(-1), seen.opened_s.value_or(-1), one.bystanders,
                   one.camera, seen.causes);
      for (const GalleryAttempt& a : seen.attempts) {
        if (why)
          fmt::print(
              "  {:5.1f} s {:<9} {} moments, {} seen, {} his, {} held, {} swipes: turned {:.0f}, along {:.0f}, zoom "
              "{:.2f}; at ({:.2f} {:.2f} {:.2f}) closed {:.2f}\n",
              a.from_s, a.tries, a.moments, a.seen, a.kept, a.held, a.swipes, a.turned_deg, a.along_deg, a.zoomed,
              a.at_m.x, a.at_m.y, a.at_m.z, a.closed);
        Tries& of = tries[a.tries];
        ++of.count;
        of.seen += a.seen > 0;
        of.kept += a.kept > 0;
        of.held += a.held > 0 || a.swipes > 0;
        of.moved += a.turned_deg > 5.0 || std::abs(a.zoomed) > 0.08;
        of.meant += a.wants == Intention::kZoom ? std::abs(a.zoomed) > 0.08 : a.along_deg > 8.0;
      }
    }
    print(kNames[kind], figures);
  }
  print("all", all);
  if (!why) return 0;
  fmt::print("\n{:<10} {:>6} {:>6} {:>6} {:>8} {:>6} {:>9}\n", "tries", "times", "seen", "his", "gesture", "moved",
             "as meant");
  for (const auto& [name, of] : tries)
    fmt::print("{:<10} {:>6} {:>6} {:>6} {:>8} {:>6} {:>9}\n", name, of.count, of.seen, of.kept, of.held, of.moved,
               of.meant);
}
