// Beam and panel of the simulated scanner: the curve of the tube, scatter, photons, gains, the words that choose them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/base/system/parallel.h"
#include "core/phantom/scan_file.h"
#include "core/phantom/scanner/panel.h"
#include "core/phantom/scanner/photon_noise.h"
#include "tests/core/phantom/scanner_object.h"

namespace dubsar::phantom {
namespace {

using namespace testing;  // NOLINT

/// Klein and Nishina's cross section in barn an electron.
double klein_nishina(double kev) {
  const double k = kev / 510.99895, l = std::log1p(2.0 * k);
  constexpr double kTwoPiR2 = 0.49893439;
  return kTwoPiR2 * ((1.0 + k) / (k * k) * (2.0 * (1.0 + k) / (1.0 + 2.0 * k) - l / k) + l / (2.0 * k) -
                     (1.0 + 3.0 * k) / ((1.0 + 2.0 * k) * (1.0 + 2.0 * k)));
}

// Clay without lime by a closed form: photoelectric absorption as E^-3, and free electrons.
TEST(ScannerBeam, ClayIsThatOfPhotoeffectAndComptonScattering) {
  EXPECT_NEAR(klein_nishina(100.0), 0.4927, 2e-4);  // the table of Hubbell 1969
  for (const double kev : {40.0, 60.0, 80.0, 100.0, 150.0}) {
    // 5 % of Fe2O3 is .033 cm2/g more at 60 keV than kaolinite's .085 of photoeffect
    const double closed = 0.118 * std::pow(60.0 / kev, 3.0) + 0.301 * klein_nishina(kev);
    EXPECT_NEAR(clay_attenuation(kev, 0.0) / closed, 1.0, kev < 50.0 ? 0.08 : 0.05) << kev;
  }
  // Quartz is .251 at 60 keV, calcite .376, soil was measured as .244 at 59.5 (Ferraz, Mansell 1979).
  EXPECT_NEAR(clay_attenuation(59.5, 0.0), 0.275, 0.01);
  EXPECT_NEAR(clay_attenuation(60.0, 0.2) - clay_attenuation(60.0, 0.0), 0.2 * (0.376 - 0.239), 1e-3);
}

// The curve by an integral of its own: Kramers, copper, caesium iodide. Below 69.5 kV tungsten has no K lines; above
// they are the tolerance.
TEST(ScannerBeam, HardeningIsTheIntegralOfTheSpectrum) {
  struct Tube {
    double kv, copper, tolerance;
  };
  for (const Tube& tube : {Tube{69.0, 0.2, 0.003}, Tube{120.0, 0.5, 0.02}, Tube{160.0, 1.5, 0.05}}) {
    BeamOptions options;
    options.kv = tube.kv;
    options.copper_mm = tube.copper;
    const Beam beam(options);
    double previous = 1e9;
    for (const double mm : {5.0, 20.0, 60.0}) {
      double open = 0.0, behind = 0.0;
      for (double kev = 15.01; kev < tube.kv; kev += 0.02) {
        const double weight = (tube.kv - kev) * std::exp(-copper_attenuation(kev) * 8.96 * 0.1 * tube.copper) *
                              (1.0 - std::exp(-csi_attenuation(kev) * 4.51 * 0.06));
        open += weight;
        behind += weight * std::exp(-clay_attenuation(kev, 0.15) * 1.8 * 0.1 * mm);
      }
      EXPECT_NEAR(std::log(beam.transmission(mm)) / std::log(behind / open), 1.0, tube.tolerance) << mm;
      const double slope = -std::log(beam.transmission(mm)) / mm;
      EXPECT_LT(slope, previous) << "what is left is harder";
      previous = slope;
      const BeamTable table(beam, 80.0);
      EXPECT_NEAR(static_cast<double>(table.transmission(static_cast<float>(mm))) / beam.transmission(mm), 1.0, 1e-5);
    }
    EXPECT_NEAR(-std::log(beam.transmission(1e-4)) / 1e-4, beam.clay_per_mm(), 1e-5);
    EXPECT_GT(beam.excess(0.0), 1.02);
  }
  BeamOptions one;
  one.mono_kev = 80.0;
  EXPECT_NEAR(Beam(one).transmission(40.0), std::exp(-40.0 * clay_attenuation(80.0, 0.15) * 0.18), 1e-9);
  EXPECT_NEAR(Beam(one).excess(10.0), 1.0, 1e-12);
}

PanelOptions quiet() { return {.photons = 0.0, .electronic = 0.0, .scatter = 0.0, .rings = 0.0, .blur_vox = 0.0}; }

BeamOptions mono() {
  BeamOptions beam;
  beam.mono_kev = 80.0;
  return beam;
}

/// Views that are `mm` of clay everywhere, one pixel in the middle with `detail` less.
Columns wall(const ScanGeometry& g, float mm, float detail) {
  Columns views(g.views, g.columns, g.rows);
  views.clear();
  for (std::int64_t i = 0; i < g.views * g.columns; ++i)
    std::fill_n(views.values.data() + i * views.stride, g.rows, mm);
  for (std::int64_t view = 0; view < g.views; ++view) views.at(view, g.columns / 2)[g.rows / 2] -= detail;
  return views;
}

TEST(ScannerPanel, ScatterTakesTheContrastOfADetail) {
  const ScanGeometry g = geometry({64, 64, 64}, 0.0, true, 2);
  const double per_mm = Beam(mono()).clay_per_mm();
  PanelOptions options = quiet();
  options.scatter = 0.12;
  SilentProgress progress;
  Columns views = wall(g, 60.0f, 0.1f);
  const auto longest = Panel(mono(), options, g, 1).expose(views, progress);
  ASSERT_TRUE(longest);
  EXPECT_NEAR(longest->clay_mm, 60.0, 1e-5);
  const double primary = std::exp(-60.0 * per_mm);
  const auto at = [&](std::int64_t off) { return static_cast<double>(views.at(0, g.columns / 2 + off)[g.rows / 2]); };
  EXPECT_NEAR(at(1), -std::log(primary + 0.12), 0.002);  // its amount is that of the middle
  EXPECT_NEAR((at(1) - at(0)) / (0.1 * per_mm), primary / (primary + 0.12), 0.01 * primary / (primary + 0.12) + 0.002);
}

TEST(ScannerPanel, PhotonsAreAsManyAsTheBeamLeaves) {
  const ScanGeometry g = geometry({96, 96, 96}, 0.0, true, 2);
  BeamOptions tube;
  tube.kv = 120.0;
  const Beam beam(tube);
  PanelOptions options = quiet();
  options.photons = 2e4;
  SilentProgress progress;
  Columns views = wall(g, 30.0f, 0.0f);
  ASSERT_TRUE(Panel(tube, options, g, 3).expose(views, progress));
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (std::int64_t i = 0; i < g.views * g.columns; ++i)
    for (std::int64_t row = 0; row < g.rows; ++row) {
      const auto p = static_cast<double>(views.values[i * views.stride + row]);
      sum += p, squares += p * p, n += 1.0;
    }
  const double light = beam.transmission(30.0), variance = squares / n - sum / n * (sum / n);
  EXPECT_NEAR(sum / n, -std::log(light), 0.002);
  EXPECT_NEAR(variance * 2e4 * light / beam.excess(30.0), 1.0, 0.04);  // 27000 samples: .9 % of deviation
}

TEST(ScannerPanel, CountsFollowPoisson) {
  for (const double mean : {0.4, 4.0, 29.0, 31.0, 400.0}) {
    double sum = 0.0, squares = 0.0, cubes = 0.0;
    constexpr int kCount = 40000;
    for (int i = 0; i < kCount; ++i) {
      const double k = poisson(mean, PixelDraw(hash64(static_cast<std::uint64_t>(i) + 77)));
      sum += k, squares += (k - mean) * (k - mean), cubes += std::pow(k - mean, 3.0);
    }
    EXPECT_NEAR(sum / kCount / mean, 1.0, 4.0 / std::sqrt(mean * kCount)) << mean;
    EXPECT_NEAR(squares / kCount / mean, 1.0, 0.04) << mean;
    EXPECT_NEAR(cubes / kCount / mean, 1.0, 0.12 + 0.06 * std::sqrt(mean)) << mean;
  }
}

TEST(ScannerPanel, GainsAreTheSameInEveryViewAndOfTheirDeviation) {
  const ScanGeometry g = geometry({300, 64, 200}, 0.0, true, 2);
  PanelOptions options = quiet();
  options.rings = 0.01;
  SilentProgress progress;
  Columns views = wall(g, 20.0f, 0.0f);
  ASSERT_TRUE(Panel(mono(), options, g, 5).expose(views, progress));
  EXPECT_EQ(0, std::memcmp(views.at(0, 0), views.at(1, 0), sizeof(float) * g.columns * views.stride));
  double squares = 0.0, neighbours = 0.0, n = 0.0;
  const double clean = 20.0 * Beam(mono()).clay_per_mm();
  for (std::int64_t column = 0; column < g.columns; ++column)
    for (std::int64_t row = 0; row + 1 < g.rows; ++row) {
      const double a = static_cast<double>(views.at(0, column)[row]) - clean;
      const double b = static_cast<double>(views.at(0, column)[row + 1]) - clean;
      squares += a * a, neighbours += a * b, n += 1.0;
    }
  EXPECT_NEAR(std::sqrt(squares / n), 0.01, 0.0008);
  EXPECT_NEAR(neighbours / squares, 0.6, 0.08);
}

TEST(ScannerPanel, SameBytesForAnyThreads) {
  const ScanGeometry g = geometry({40, 40, 40}, 5.0, true, 12);
  const Panel panel(BeamOptions{}, parse_scanner("strong").value().panel, g, 9);
  SilentProgress progress;
  set_thread_count(1);
  Columns one = wall(g, 30.0f, 1.0f);
  ASSERT_TRUE(panel.expose(one, progress));
  set_thread_count(3);
  Columns three = wall(g, 30.0f, 1.0f);
  ASSERT_TRUE(panel.expose(three, progress));
  set_thread_count(0);
  EXPECT_EQ(0, std::memcmp(one.values.data(), three.values.data(), sizeof(float) * one.values.size()));
}

TEST(ScannerOptionsText, WordsChangeWhatTheyNameAndOthersAreRefused) {
  const ScannerOptions o = parse_scanner("strong,scatter=0.2,turn=half,cone=0,file=uint16,pad=0,window=hann").value();
  EXPECT_EQ(o.panel.scatter, 0.2);
  EXPECT_EQ(o.beam.kv, 120.0);
  EXPECT_FALSE(o.turn.full);
  EXPECT_EQ(o.turn.window, Window::kHann);
  EXPECT_EQ(o.file.type, ScanFile::kUint16);
  EXPECT_EQ(o.file.pad, Pad::kValue);
  EXPECT_EQ(parse_scanner("").value().beam.kv, parse_scanner("good").value().beam.kv);
  for (const auto& [text, said] :
       {std::pair{"loud", "loud"}, std::pair{"kv=20", "kv"}, std::pair{"turn=third", "third"},
        std::pair{"good,colour=3", "colour"}, std::pair{"file=hu,pad=nan", "pad=nan"}, std::pair{"mono=5", "mono=5"},
        std::pair{"pad=round", "pad=round"}}) {
    const auto refused = parse_scanner(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_NE(refused.error().message.find(said), std::string::npos) << refused.error().message;
  }
}

TEST(ScannerGeometry, TheSourceStandsOutsideTheObject) {
  TurnOptions turn;
  turn.cone_deg = 29.0;
  EXPECT_FALSE(make_geometry({400, 400, 100}, 0.2, turn));
  turn.cone_deg = 5.0;
  const ScanGeometry g = make_geometry({1871, 999, 1723}, 0.038, turn).value();
  EXPECT_LE(g.columns, 3072);  // the panel of the paper's instrument
  EXPECT_LE(g.rows, 1944);
  EXPECT_GE(g.columns, 2122);  // all of the grid's diagonal
}

ScannedVolume ramp_volume() {
  ScannedVolume scan;
  scan.per_mm = Volume<float>({40, 24, 10});
  for (std::int64_t i = 0; i < scan.per_mm.dims.count(); ++i)
    scan.per_mm.voxels[i] = -0.01f + 0.07f * static_cast<float>(i) / static_cast<float>(scan.per_mm.dims.count());
  scan.water_per_mm = 0.019;
  return scan;
}

TEST(ScannerFile, WholeNumbersMeanWhatTheFloatsSay) {
  const ScannedVolume scan = ramp_volume();
  FileOptions options{.type = ScanFile::kUint16, .pad = Pad::kValue, .pad_value = 0.0, .blank = 2};
  const StoredScan stored = stored_scan(scan, options);
  const auto numbers = store_slices<std::uint16_t>(scan, stored, options, 0, 10);
  EXPECT_EQ(numbers[20 + 12 * 40], 0);  // blank slices
  EXPECT_EQ(numbers[4 * 960 + 0], 0);   // a corner is beyond the circle
  for (const std::size_t i : {std::size_t{4 * 960 + 12 * 40 + 3}, std::size_t{7 * 960 + 10 * 40 + 30}})
    EXPECT_NEAR(numbers[i] * stored.map.scale + stored.map.offset,
                static_cast<double>(scan.per_mm.voxels[static_cast<std::int64_t>(i)]), 0.51 * stored.map.scale);
  options = {.type = ScanFile::kHu, .pad = Pad::kLeast};
  const StoredScan hu = stored_scan(scan, options);
  const auto words = store_slices<std::int16_t>(scan, hu, options, 5, 6);
  const auto expected = 1000.0 * (static_cast<double>(scan.per_mm.at(20, 12, 5)) / 0.019 - 1.0);
  EXPECT_NEAR(words[12 * 40 + 20], expected, 0.5);
  EXPECT_EQ(words[0], std::lround(1000.0 * (-0.01 / 0.019 - 1.0)));  // air is -1000, its noise less
}

}  // namespace
}  // namespace dubsar::phantom
