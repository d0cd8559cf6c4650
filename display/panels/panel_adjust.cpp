#include "display/panels/panel_adjust.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"
#include "core/base/text/parse_number.h"

namespace dubsar {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kSuffix = ".adjust.json";
constexpr std::int64_t kMaxBytes = 1 << 16;

fs::path file_of(const fs::path& folder, std::string_view panel) {
  return folder / (std::string(panel) + std::string(kSuffix));
}

Result<void> check_figure(std::string_view panel, const char* name, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return {};
  return fail(ErrorKind::kConfig, "adjustment of panel {}: {} is {}, expected {} to {}", panel, name, value, low, high);
}

}  // namespace

Result<PanelAdjustment> parse_adjustment(std::string_view text) {
  PanelAdjustment out;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    const auto equals = word.find('=');
    const std::string_view key = word.substr(0, equals);
    std::optional<double>* const place = key == "pitch"    ? &out.pitch
                                         : key == "slope"  ? &out.slope
                                         : key == "center" ? &out.center
                                                           : nullptr;
    const auto value = equals == std::string_view::npos ? std::nullopt : parse_number(word.substr(equals + 1));
    if (!value || place == nullptr || *place)
      return fail(ErrorKind::kUsage,
                  "adjustment \"{}\" not understood at \"{}\", expected pitch=NUMBER,slope=NUMBER,center=NUMBER, each "
                  "once at most",
                  text, word);
    *place = *value;
  }
  if (out.empty())
    return fail(ErrorKind::kUsage, "adjustment \"{}\" is empty, expected pitch=NUMBER,slope=NUMBER,center=NUMBER",
                text);
  return out;
}

Result<void> apply_adjustment(const PanelAdjustment& adjustment, PanelProfile& profile) {
  if (adjustment.empty()) return {};
  const auto& [pitch, slope, center] = adjustment;
  const bool tracked = profile.optics.has_value();
  if (!tracked && !profile.sheet)
    return fail(ErrorKind::kConfig, "adjustment of panel {}: it has no lens figures, give the unit's calibration file",
                profile.name);
  if (pitch)
    DUBSAR_TRY(check_figure(profile.name, "pitch", *pitch, tracked ? 0.01 : kLeastPitch, tracked ? 10.0 : kMostPitch));
  if (slope)
    DUBSAR_TRY(check_figure(profile.name, "slope", *slope, tracked ? -10.0 : -kMostSlope, tracked ? 10.0 : kMostSlope));
  if (slope && !tracked && std::abs(*slope) < kLeastSlope)
    return fail(ErrorKind::kConfig, "adjustment of panel {}: slope is {}, expected {} or more, of either sign",
                profile.name, *slope, kLeastSlope);
  if (center) DUBSAR_TRY(check_figure(profile.name, "center", *center, -kMostCentre, kMostCentre));
  double& pitch_of = tracked ? profile.optics->pitch_mm : profile.sheet->pitch;
  double& slope_of = tracked ? profile.optics->tan_slant : profile.sheet->slope;
  double& center_of = tracked ? profile.optics->phase0 : profile.sheet->center;
  pitch_of = pitch.value_or(pitch_of);
  slope_of = slope.value_or(slope_of);
  center_of = center.value_or(center_of);
  profile.lenses.adjustment = adjustment;
  return {};
}

namespace {

/// `panel` becomes the name that the file says.
Result<void> read_adjustment(const fs::path& file, PanelSet& panels, std::string& panel) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(file, kMaxBytes));
  DUBSAR_ASSIGN(const nlohmann::json object, parse_json(text, file.string()));
  JsonFields fields(object, fmt::format("adjustment {}", file.string()));
  if (!object.is_object()) fields.complain(fmt::format("{} found, expected an object", object.type_name()));
  const std::string named = fields.text("adjusts", nullptr);
  PanelAdjustment adjustment;
  for (const auto& [name, place] :
       {std::pair{"pitch", &adjustment.pitch}, {"slope", &adjustment.slope}, {"center", &adjustment.center}})
    if (fields.has(name)) *place = fields.number(name, -kMostSlope, kMostSlope);
  if (is_panel_name(named))
    panel = named;
  else
    fields.complain("adjusts is not the name of a panel, expected letters, digits, '.', '-' and '_'");
  DUBSAR_TRY(fields.finish());
  for (PanelProfile& profile : panels.profiles)
    if (profile.name == panel) {
      const bool waits = !profile.sheet && !profile.optics;  // for a calibration
      if (waits) profile.lenses.adjustment = adjustment;
      const auto applied = waits ? Result<void>() : apply_adjustment(adjustment, profile);
      if (!applied) return fail(ErrorKind::kConfig, "{}: {}", file.string(), applied.error().message);
      return {};
    }
  return fail(ErrorKind::kConfig, "adjustment {}: no panel is called \"{}\", so it is not used", file.string(), panel);
}

}  // namespace

bool is_adjustment_file(const fs::path& file) { return file.filename().string().ends_with(kSuffix); }

void load_adjustment(const fs::path& file, PanelSet& panels) {
  std::string panel = file.filename().string();
  panel.erase(panel.size() - kSuffix.size());
  if (auto read = read_adjustment(file, panels, panel); !read)
    panels.problems.push_back({file, panel, read.error().message});
}

Result<fs::path> save_adjustment(const fs::path& folder, std::string_view panel, const PanelAdjustment& adjustment) {
  DUBSAR_ASSIGN(PanelProfile profile, load_panels(folder).find(panel));
  return save_adjustment(folder, std::move(profile), adjustment);
}

Result<fs::path> save_adjustment(const fs::path& folder, PanelProfile profile, const PanelAdjustment& adjustment) {
  PanelAdjustment all = profile.lenses.adjustment;
  if (adjustment.pitch) all.pitch = adjustment.pitch;
  if (adjustment.slope) all.slope = adjustment.slope;
  if (adjustment.center) all.center = adjustment.center;
  DUBSAR_TRY(apply_adjustment(all, profile));
  nlohmann::json object{{"adjusts", profile.name}};
  if (all.pitch) object["pitch"] = *all.pitch;
  if (all.slope) object["slope"] = *all.slope;
  if (all.center) object["center"] = *all.center;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(ErrorKind::kCannotCreate, "cannot create the folder {}: {}", folder.string(), error.message());
  const fs::path file = file_of(folder, profile.name);
  DUBSAR_TRY(write_file_atomically(file, dump_json_lines(object) + "\n"));
  return file;
}

Result<bool> remove_adjustment(const fs::path& folder, std::string_view panel) {
  const fs::path file = file_of(folder, panel);
  std::error_code error;
  const bool plain = is_panel_name(panel);  // else the name would lead out of the folder
  const bool removed = plain && fs::remove(file, error);
  if (error) return fail(ErrorKind::kIo, "cannot remove {}: {}", file.string(), error.message());
  if (removed) return true;
  if (const auto known = load_panels(folder).find(panel); !known && known.error().kind == ErrorKind::kUsage)
    return tl::unexpected<Error>(known.error());
  return false;
}

}  // namespace dubsar
