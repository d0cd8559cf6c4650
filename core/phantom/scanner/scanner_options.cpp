#include "core/phantom/scanner/scanner_options.h"

#include <cmath>
#include <string>

#include "core/base/text/option_reader.h"
#include "core/base/text/parse_number.h"

namespace dubsar::phantom {
namespace {

Result<ScannerOptions> preset(std::string_view word) {
  ScannerOptions o;
  if (word.empty() || word == "good") return o;
  if (word == "mild") {
    o.beam.kv = 150.0;
    o.beam.copper_mm = 1.0;
    o.panel.photons = 3e5;
    o.panel.scatter = 0.03;
    o.panel.rings = 0.002;
    o.panel.bad = 1e-4;
    o.turn.axis_px = 0.1;
  } else if (word == "medium") {
    o.beam.kv = 130.0;
    o.beam.copper_mm = 0.5;
    o.panel.photons = 1e5;
    o.panel.scatter = 0.06;
    o.panel.glare = 0.005;
    o.panel.rings = 0.005;
    o.panel.bad = 3e-4;
    o.turn.axis_px = 0.25;
    o.turn.views_per_voxel = 1.25;
  } else if (word == "strong") {
    o.beam.kv = 120.0;
    o.beam.copper_mm = 0.5;
    o.beam.clay_g_cm3 = 2.0;
    o.beam.lime = 0.25;
    o.panel.photons = 5e4;
    o.panel.scatter = 0.2;
    o.panel.glare = 0.01;
    o.panel.rings = 0.01;
    o.panel.bad = 5e-4;
    o.turn.axis_px = 0.5;
    o.turn.views_per_voxel = 1.0;
  } else if (word == "ideal") {
    o.beam.mono_kev = 80.0;
    o.panel = {.photons = 0.0, .electronic = 0.0, .scatter = 0.0, .rings = 0.0};
  } else {
    return fail(ErrorKind::kUsage, "phantom: scanner \"{}\" is unknown, expected good, mild, medium, strong or ideal",
                word);
  }
  return o;
}

template <class Enum, std::size_t kCount>
Enum choose(OptionReader& reader, std::string_view key, const EnumName<Enum> (&table)[kCount], Enum fallback) {
  const std::string word = reader.text(key);
  if (word.empty()) return fallback;
  std::string names;
  for (const EnumName<Enum>& entry : table) {
    if (entry.name == word) return entry.value;
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  reader.complain(std::string(key) + "=" + word + " found, expected one of " + names);
  return fallback;
}

void read_pad(OptionReader& reader, FileOptions& file) {
  const std::string word = reader.text("pad");
  if (word.empty() || word == "none") return;
  if (word == "min") {
    file.pad = Pad::kLeast;
  } else if (word == "nan") {
    file.pad = Pad::kNan;
    if (file.type != ScanFile::kFloat) reader.complain("pad=nan needs file=float: whole numbers have no NaN");
  } else if (const auto number = parse_number(word)) {
    file.pad = Pad::kValue;
    file.pad_value = *number;
  } else {
    reader.complain("pad=" + word + " found, expected none, min, nan or a number");
  }
}

}  // namespace

Result<ScannerOptions> parse_scanner(std::string_view text) {
  DUBSAR_ASSIGN(std::vector<Option> list, parse_options(text, "scanner"));
  OptionReader reader(std::move(list), "scanner");
  DUBSAR_ASSIGN(ScannerOptions o, preset(reader.first_word()));
  BeamOptions& beam = o.beam;
  beam.kv = reader.number("kv", 40.0, 300.0, beam.kv);
  beam.copper_mm = reader.number("filter", 0.0, 20.0, beam.copper_mm);
  beam.mono_kev = reader.number("mono", 0.0, 300.0, beam.mono_kev);
  beam.clay_g_cm3 = reader.number("clay", 0.1, 10.0, beam.clay_g_cm3);
  beam.lime = reader.number("lime", 0.0, 0.9, beam.lime);
  PanelOptions& panel = o.panel;
  panel.photons = reader.number("photons", 0.0, 1e12, panel.photons);
  panel.electronic = reader.number("electronic", 0.0, 1e6, panel.electronic);
  panel.scatter = reader.number("scatter", 0.0, 2.0, panel.scatter);
  panel.spread_mm = reader.number("spread", 1.0, 1000.0, panel.spread_mm);
  panel.glare = reader.number("glare", 0.0, 0.5, panel.glare);
  panel.rings = reader.number("rings", 0.0, 0.2, panel.rings);
  panel.bad = reader.number("bad", 0.0, 0.1, panel.bad);
  panel.blur_vox = reader.number("blur", 0.0, 5.0, panel.blur_vox);
  TurnOptions& turn = o.turn;
  constexpr EnumName<bool> kTurns[] = {{false, "half"}, {true, "full"}};
  turn.full = choose(reader, "turn", kTurns, turn.full);
  turn.views = reader.integer("views", 0, 100000, turn.views);
  turn.cone_deg = reader.number("cone", 0.0, 30.0, turn.cone_deg);
  turn.axis_px = reader.number("axis", -20.0, 20.0, turn.axis_px);
  turn.start_deg = reader.number("start", -360.0, 360.0, turn.start_deg);
  turn.window = choose(reader, "window", kWindows, turn.window);
  o.file.type = choose(reader, "file", kScanFiles, o.file.type);
  o.file.blank = reader.integer("blank", 0, 1000, o.file.blank);
  read_pad(reader, o.file);
  o.text = text.empty() ? "good" : text;
  DUBSAR_TRY(reader.finish());
  if (beam.mono_kev > 0.0 && beam.mono_kev < 15.0)
    return fail(ErrorKind::kUsage, "scanner: mono={} keV found, expected 15 to 300, or 0 for the tube's spectrum",
                beam.mono_kev);
  return o;
}

}  // namespace dubsar::phantom
