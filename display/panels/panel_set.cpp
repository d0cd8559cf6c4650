#include "display/panels/panel_set.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_text.h"
#include "core/base/text/near_word.h"
#include "display/panels/embedded_profiles.h"
#include "display/panels/panel_adjust.h"

namespace dubsar {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::int64_t kMaxProfileBytes = 1 << 20;

std::string name_of(const json& object) {
  return object.is_object() && object.contains("name") && object["name"].is_string() ? object["name"].get<std::string>()
                                                                                     : std::string();
}

void add_profile(const json& object, const fs::path& file, PanelSet& panels) {
  auto profile = parse_profile(object, file.string());
  if (profile)
    panels.put(*std::move(profile));
  else
    panels.problems.push_back({file, name_of(object), profile.error().message});
}

void add_profiles(const Result<std::string>& text, const fs::path& file, PanelSet& panels) {
  const auto parsed = text ? parse_json(*text, file.string()) : Result<json>(tl::unexpect, text.error());
  if (!parsed) {
    panels.problems.push_back({file, {}, parsed.error().message});
  } else if (parsed->is_array() && !parsed->empty()) {
    for (const json& object : *parsed) add_profile(object, file, panels);
  } else {
    add_profile(*parsed, file, panels);
  }
}

}  // namespace

Result<PanelProfile> PanelSet::find(std::string_view name) const {
  for (const PanelProblem& problem : problems)
    if (problem.panel == name && !name.empty()) return fail(ErrorKind::kConfig, "{}", problem.reason);
  std::string names;
  for (const PanelProfile& profile : profiles) {
    if (profile.name == name) return profile;
    names += (names.empty() ? "" : ", ") + profile.name;
  }
  std::string unread;
  for (const PanelProblem& problem : problems) unread += "; not read: " + problem.reason;
  return fail(ErrorKind::kUsage, "no panel profile is called \"{}\", expected one of: {}{}{}", name, names, unread,
              did_you_mean(name, names));
}

void PanelSet::put(PanelProfile profile) {
  std::erase_if(problems, [&](const PanelProblem& problem) { return problem.panel == profile.name; });
  const auto same =
      std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.name == profile.name; });
  if (same == profiles.end())
    profiles.push_back(std::move(profile));
  else
    *same = std::move(profile);
}

const PanelSet& built_in_panels() {
  static const PanelSet panels = [] {
    PanelSet out;
    for (const auto& [name, text] : embedded_profiles()) add_profiles(std::string(text), fs::path(name), out);
    DUBSAR_CHECK(out.problems.empty());
    return out;
  }();
  return panels;
}

PanelSet load_panels(const fs::path& user_folder) {
  PanelSet panels = built_in_panels();
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(user_folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".json") files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    if (!is_adjustment_file(file)) add_profiles(read_text_file(file, kMaxProfileBytes), file, panels);
  for (const fs::path& file : files)
    if (is_adjustment_file(file)) load_adjustment(file, panels);
  return panels;
}

std::vector<const PanelProfile*> panels_of_edid(const PanelSet& panels, const Edid& edid) {
  constexpr double kWidthTolerance = 0.15;
  const auto same_size = [&](const PanelProfile& p) {
    return p.width_px == edid.width_px && p.height_px == edid.height_px &&
           (edid.width_mm == 0 || std::abs(p.width_mm / edid.width_mm - 1.0) < kWidthTolerance);
  };
  const auto starts_like = [](const std::string& text, const std::string& prefix) {
    return !prefix.empty() && text.starts_with(prefix);
  };
  std::vector<const PanelProfile*> by_serial, by_size, tracked;
  for (const PanelProfile& p : panels.profiles) {
    if (!same_size(p)) continue;
    if (p.kind == PanelKind::kLookingGlass && edid.name.starts_with("LKG")) {
      by_size.push_back(&p);
      if (starts_like(edid.name, p.marks.serial_prefix) || starts_like(edid.serial, p.marks.serial_prefix))
        by_serial.push_back(&p);
    }
    if (std::any_of(p.marks.edids.begin(), p.marks.edids.end(), [&](const EdidId& id) {
          return id.manufacturer == edid.manufacturer && id.product == edid.product;
        }))
      tracked.push_back(&p);
  }
  if (!by_serial.empty()) return by_serial;
  return by_size.empty() ? tracked : by_size;
}

}  // namespace dubsar
