#include "input/source_spec.h"

#include <algorithm>

namespace dubsar {

std::string SourceSpec::text() const { return options.empty() ? name : name + ':' + options_text(options); }

Result<SourceSpec> parse_source(std::string_view text) {
  const auto colon = text.find(':');
  SourceSpec spec{std::string(text.substr(0, colon))};
  if (spec.name.empty() || spec.name.find_first_of(",=\"") != std::string::npos)
    return fail(ErrorKind::kUsage, "input \"{}\" has no name, expected NAME or NAME:OPTION,...", text);
  if (colon == std::string_view::npos) return spec;
  if (colon + 1 == text.size())
    return fail(ErrorKind::kUsage, "input \"{}\": found no option after the colon, expected NAME or NAME:OPTION,...",
                text);
  auto options = parse_options(text.substr(colon + 1));
  if (!options) return fail(ErrorKind::kUsage, "input {}: {}", spec.name, options.error().message);
  spec.options = *std::move(options);
  return spec;
}

Result<std::vector<SourceSpec>> parse_sources(std::string_view text, std::span<const std::string_view> names) {
  std::vector<std::string> sources;
  for (const std::string_view word : split_at_commas(text)) {
    const auto mark = word.find_first_of(":=\"");
    const bool has_name = mark != std::string_view::npos && word[mark] == ':';
    if (sources.empty() || has_name || std::find(names.begin(), names.end(), word) != names.end()) {
      sources.emplace_back(word);
    } else {
      // the first option stands behind the colon
      sources.back() += (sources.back().find(':') == std::string::npos ? ':' : ',');
      sources.back() += word;
    }
  }
  std::vector<SourceSpec> out;
  for (const std::string& source : sources) {
    DUBSAR_ASSIGN(SourceSpec spec, parse_source(source));
    out.push_back(std::move(spec));
  }
  return out;
}

}  // namespace dubsar
