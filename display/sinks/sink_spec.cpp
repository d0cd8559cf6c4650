#include "display/sinks/sink_spec.h"

namespace dubsar {
namespace {

/// One word or value, in quotation marks or up to the first of `ends`; taken off `rest`.
std::optional<std::string> take_text(std::string_view& rest, std::string_view ends) {
  std::string out;
  if (!rest.starts_with('"')) {
    out = rest.substr(0, rest.find_first_of(ends));
    rest.remove_prefix(out.size());
    return out;
  }
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == '"') {
      rest.remove_prefix(i + 1);
      return out;
    }
    const bool escaped = rest[i] == '\\' && i + 1 < rest.size() && (rest[i + 1] == '"' || rest[i + 1] == '\\');
    out += rest[escaped ? ++i : i];
  }
  return std::nullopt;
}

std::string quoted(std::string_view text, std::string_view special) {
  if (text.find_first_of(special) == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

std::string SinkSpec::options_text() const {
  std::string out;
  for (const SinkOption& option : options) {
    if (&option != options.data()) out += ',';
    out += quoted(option.key, ",\"=");
    if (option.value) out += '=' + quoted(*option.value, ",\"");
  }
  return out;
}

std::string SinkSpec::text() const { return options.empty() ? name : name + ':' + options_text(); }

Result<SinkSpec> parse_sink_spec(std::string_view text) {
  const auto colon = text.find(':');
  SinkSpec spec{std::string(text.substr(0, colon))};
  if (spec.name.empty())
    return fail(ErrorKind::kUsage, "display \"{}\" has no name, expected NAME or NAME:OPTION,...", text);
  if (colon == std::string_view::npos) return spec;
  std::string_view rest = text.substr(colon + 1);
  const auto wrong = [&](std::string_view what) {
    return fail(ErrorKind::kUsage, "display \"{}\": {} at \"{}\", expected words and key=value with commas between",
                text, what, rest);
  };
  for (;;) {
    if (rest.empty() || rest.front() == ',') return wrong("an option is empty");
    SinkOption& option = spec.options.emplace_back();
    auto word = take_text(rest, ",=");
    if (!word) return wrong("a quotation mark is not closed");
    option.key = *std::move(word);
    if (option.key.empty()) return wrong("an option has no name");
    if (rest.starts_with('=')) {
      rest.remove_prefix(1);
      option.value = take_text(rest, ",");
      if (!option.value) return wrong("a quotation mark is not closed");
    }
    if (rest.empty()) return spec;
    if (rest.front() != ',') return wrong("something stands behind a quotation mark");
    rest.remove_prefix(1);
  }
}

}  // namespace dubsar
