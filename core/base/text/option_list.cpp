#include "core/base/text/option_list.h"

namespace dubsar {
namespace {

/// One word or value, in quotation marks or up to the first of `ends`; taken off `rest`. Nothing: no closing mark.
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
  if (!text.empty() && text.find_first_of(special) == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

Result<std::vector<Option>> parse_options(std::string_view text, std::string_view subject, std::string_view whole) {
  std::vector<Option> options;
  if (text.empty()) return options;
  std::string_view rest = text;
  const auto wrong = [&](std::string_view what) {
    return fail(ErrorKind::kUsage, "{} \"{}\": {} at \"{}\", expected words and key=value with commas between", subject,
                whole.empty() ? text : whole, what, rest);
  };
  for (;;) {
    if (rest.empty() || rest.front() == ',') return wrong("an option is empty");
    Option& option = options.emplace_back();
    auto word = take_text(rest, ",=");
    if (!word) return wrong("a quotation mark is not closed");
    option.key = *std::move(word);
    if (option.key.empty()) return wrong("an option has no name");
    if (rest.starts_with('=')) {
      rest.remove_prefix(1);
      option.value = take_text(rest, ",");
      if (!option.value) return wrong("a quotation mark is not closed");
    }
    if (rest.empty()) return options;
    if (rest.front() != ',') return wrong("something stands behind a quotation mark");
    rest.remove_prefix(1);
  }
}

std::string options_text(const std::vector<Option>& options) {
  std::string out;
  for (const Option& option : options) {
    if (!out.empty()) out += ',';
    out += quoted(option.key, ",\"=");
    if (option.value) out += '=' + (option.value->empty() ? std::string() : quoted(*option.value, ",\""));
  }
  return out;
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> out;
  std::size_t begin = 0;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool may_open = i == begin || text[i - 1] == '=' || text[i - 1] == ':';
    if (inside && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"' && (inside || may_open)) {
      inside = !inside;
    } else if (text[i] == ',' && !inside) {
      out.push_back(text.substr(begin, i - begin));
      begin = i + 1;
    }
  }
  out.push_back(text.substr(begin));
  return out;
}

}  // namespace dubsar
