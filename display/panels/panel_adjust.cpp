#include "display/panels/panel_adjust.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/json_fields.h"
#include "core/base/json_text.h"
#include "core/base/log.h"

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
    double value = 0.0;
    const char* const end = word.data() + word.size();
    const bool read = equals != std::string_view::npos && place != nullptr && !*place &&
                      std::from_chars(word.data() + equals + 1, end, value).ptr == end && equals + 1 < word.size();
    if (!read)
      return fail(ErrorKind::kUsage,
                  "adjustment \"{}\" not understood at \"{}\", expected pitch=NUMBER,slope=NUMBER,center=NUMBER, each "
                  "once at most",
                  text, word);
    *place = value;
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
  profile.adjustment = adjustment;
  return {};
}

bool is_adjustment_file(const fs::path& file) { return file.filename().string().ends_with(kSuffix); }

Result<void> load_adjustment(const fs::path& file, std::span<PanelProfile> profiles) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(file, kMaxBytes));
  const auto object = parse_json(text, file.string());
  if (!object) return fail(ErrorKind::kConfig, "{}", object.error().message);
  JsonFields fields(*object, fmt::format("adjustment {}", file.string()));
  const std::string panel = fields.text("adjusts", nullptr);
  PanelAdjustment adjustment;
  for (const auto& [name, place] :
       {std::pair{"pitch", &adjustment.pitch}, {"slope", &adjustment.slope}, {"center", &adjustment.center}})
    if (fields.has(name)) *place = fields.number(name, -kMostSlope, kMostSlope);
  DUBSAR_TRY(fields.finish());
  for (PanelProfile& profile : profiles)
    if (profile.name == panel) {
      if (profile.sheet || profile.optics) return apply_adjustment(adjustment, profile);
      profile.adjustment = adjustment;  // waits for a calibration
      return {};
    }
  log_warning("adjustment {}: no panel is called \"{}\", so it is not used", file.string(), panel);
  return {};
}

Result<fs::path> save_adjustment(const fs::path& folder, std::string_view panel, const PanelAdjustment& adjustment) {
  DUBSAR_ASSIGN(const auto profiles, load_profiles(folder));
  DUBSAR_ASSIGN(PanelProfile profile, find_profile(profiles, panel));
  PanelAdjustment all = profile.adjustment;
  if (adjustment.pitch) all.pitch = adjustment.pitch;
  if (adjustment.slope) all.slope = adjustment.slope;
  if (adjustment.center) all.center = adjustment.center;
  DUBSAR_TRY(apply_adjustment(all, profile));
  nlohmann::json object{{"adjusts", panel}};
  if (all.pitch) object["pitch"] = *all.pitch;
  if (all.slope) object["slope"] = *all.slope;
  if (all.center) object["center"] = *all.center;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(ErrorKind::kCannotCreate, "cannot create the folder {}: {}", folder.string(), error.message());
  const fs::path file = file_of(folder, panel);
  DUBSAR_TRY(write_file_atomically(file, dump_json_lines(object) + "\n"));
  return file;
}

Result<bool> remove_adjustment(const fs::path& folder, std::string_view panel) {
  DUBSAR_ASSIGN(const auto profiles, load_profiles(folder));
  DUBSAR_TRY(find_profile(profiles, panel));
  std::error_code error;
  const bool removed = fs::remove(file_of(folder, panel), error);
  if (error) return fail(ErrorKind::kIo, "cannot remove {}: {}", file_of(folder, panel).string(), error.message());
  return removed;
}

}  // namespace dubsar
