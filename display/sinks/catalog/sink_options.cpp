#include "display/sinks/catalog/sink_options.h"

#include <algorithm>
#include <utility>

#include "core/base/text/parse_number.h"
#include "display/panels/panel_calibration.h"

namespace dubsar {

int SinkOptions::choice(std::span<const std::string_view> choices) {
  for (auto option = spec_.options.begin(); option != spec_.options.end(); ++option) {
    const auto found = std::find(choices.begin(), choices.end(), option->key);
    if (found == choices.end() || option->value) continue;
    spec_.options.erase(option);
    return static_cast<int>(found - choices.begin());
  }
  return 0;
}

std::optional<std::string> SinkOptions::text(std::string_view key) {
  const auto found = std::find_if(spec_.options.begin(), spec_.options.end(),
                                  [&](const SinkOption& option) { return option.key == key && option.value; });
  if (found == spec_.options.end()) return std::nullopt;
  std::optional<std::string> value = std::move(found->value);
  spec_.options.erase(found);
  return value;
}

double SinkOptions::number(std::string_view key, double least, double most, double fallback) {
  const auto given = text(key);
  if (!given) return fallback;
  const auto value = parse_number(*given);
  if (value && *value >= least && *value <= most) return *value;
  if (complaint_.empty())
    complaint_ =
        fmt::format("display {}: {}={} found, expected a number from {} to {}", spec_.name, key, *given, least, most);
  return fallback;
}

int SinkOptions::whole(std::string_view key, int least, int most, int fallback) {
  const auto given = text(key);
  if (!given) return fallback;
  const auto value = parse_whole(*given);
  if (value && *value >= least && *value <= most) return *value;
  if (complaint_.empty())
    complaint_ = fmt::format("display {}: {}={} found, expected a whole number from {} to {}", spec_.name, key, *given,
                             least, most);
  return fallback;
}

Result<std::optional<PanelProfile>> SinkOptions::panel() {
  std::optional<std::string> name = text("panel");
  const std::optional<std::string> file = text("calibration");
  if (!name) {
    const auto word = std::find_if(spec_.options.begin(), spec_.options.end(),
                                   [](const SinkOption& option) { return !option.value; });
    if (word != spec_.options.end()) {
      name = std::move(word->key);
      spec_.options.erase(word);
    }
  }
  if (!name && !file) return std::nullopt;
  if (file && file->empty())
    return fail(ErrorKind::kUsage, "display {}: calibration= found, expected calibration=FILE", spec_.name);
  DUBSAR_ASSIGN(PanelProfile profile, choose_panel(*panels_, name.value_or(""), file.value_or("")));
  return profile;
}

Result<void> SinkOptions::finish(std::string_view known) {
  if (!complaint_.empty()) return fail(ErrorKind::kUsage, "{}", complaint_);
  if (spec_.options.empty()) return {};
  const SinkSpec left{{}, {spec_.options.front()}};
  return fail(ErrorKind::kUsage, "display {}: option \"{}\" is not known or given twice, expected {}", spec_.name,
              left.options_text(), known);
}

}  // namespace dubsar
