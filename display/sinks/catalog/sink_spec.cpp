#include "display/sinks/catalog/sink_spec.h"

namespace dubsar {

std::string SinkSpec::options_text() const { return dubsar::options_text(options); }

std::string SinkSpec::text() const { return options.empty() ? name : name + ':' + options_text(); }

Result<SinkSpec> parse_sink_spec(std::string_view text) {
  const auto colon = text.find(':');
  SinkSpec spec{std::string(text.substr(0, colon))};
  if (spec.name.empty())
    return fail(ErrorKind::kUsage, "display \"{}\" has no name, expected NAME or NAME:OPTION,...", text);
  if (colon == std::string_view::npos) return spec;
  if (colon + 1 == text.size())
    return fail(ErrorKind::kUsage,
                "display \"{}\": an option is empty at \"\", expected words and key=value with commas between", text);
  DUBSAR_ASSIGN(spec.options, parse_options(text.substr(colon + 1), "display", text));
  return spec;
}

}  // namespace dubsar
