#include "app/words/language.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/words/language_files.h"
#include "core/base/files/atomic_file.h"
#include "core/base/text/json_text.h"
#include "core/base/text/lower_text.h"

namespace dubsar::app {
namespace {

constexpr char kBetweenForms = '|';

std::vector<std::string> forms_of(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (c == kBetweenForms)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

/// Those of the languages in the program that were asked for, and files; they stay, as texts of them are held.
std::map<std::string, std::unique_ptr<Language>, std::less<>>& known() {
  static std::map<std::string, std::unique_ptr<Language>, std::less<>> all;
  return all;
}

const Language& english() {
  static const Language only;
  return only;
}

const Language*& present() {
  static const Language* now = &english();
  return now;
}

/// Each number in braces that the text has, in any order, once.
std::vector<bool> places_in(std::string_view text) {
  std::vector<bool> out(values_of(text));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = text.find(fmt::format("{{{}}}", i)) != std::string_view::npos;
  return out;
}

}  // namespace

Language::Language() {
  for (const TextRow& row : kEnglish) texts_.emplace_back(row.text);
}

std::size_t Language::forms() const noexcept {
  const std::string& rule = (*this)[Text("language.plural")];
  return rule == "none" ? 1 : rule == "slavic" ? 3 : 2;
}

std::size_t Language::form(long long count) const noexcept {
  const std::string& rule = (*this)[Text("language.plural")];
  if (rule == "none") return 0;
  if (rule == "zero-one") return count == 0 || count == 1 ? 0 : 1;
  if (rule != "slavic") return count == 1 ? 0 : 1;
  if (count % 10 == 1 && count % 100 != 11) return 0;
  return count % 10 >= 2 && count % 10 <= 4 && (count % 100 < 12 || count % 100 > 14) ? 1 : 2;
}

Result<Language> Language::parse(std::string_view code, std::string_view json_text, std::string_view source) {
  DUBSAR_ASSIGN(const nlohmann::json object, parse_json(json_text, source));
  if (!object.is_object())
    return fail(ErrorKind::kConfig, "{}: no object of texts found, expected {{\"tool.turn\": \"...\"}}", source);
  Language out;
  out.code_ = code;
  for (const auto& [id, text] : object.items()) {
    const Text at = Text::find(id);
    if (at.empty())
      return fail(ErrorKind::kConfig, "{}: there is no text \"{}\"; its ids are those of en.json", source, id);
    if (!text.is_string() || text.get_ref<const std::string&>().empty())
      return fail(ErrorKind::kConfig, "{}: {} is no text", source, id);
    out.texts_[at.place()] = text.get<std::string>();
    ++out.translated_;
  }
  for (const TextRow& row : kEnglish) {
    const Text at = Text::find(row.id);
    const bool counts = row.text.find(kBetweenForms) != std::string_view::npos;
    const std::vector<std::string> forms = forms_of(out[at]);
    if (out[at] == row.text) {  // English, with as many forms as the language has
      if (counts && out.forms() == 1) out.texts_[at.place()] = forms.back();
      if (counts && out.forms() == 3) out.texts_[at.place()] += kBetweenForms + forms.back();
      continue;
    }
    if (forms.size() != (counts ? out.forms() : 1))
      return fail(ErrorKind::kConfig, "{}: {} has {} forms, expected {}", source, row.id, forms.size(),
                  counts ? out.forms() : 1);
    for (const std::string& form : forms)
      if (places_in(form) != places_in(row.text))
        return fail(ErrorKind::kConfig, "{}: {} is \"{}\", expected the same places in braces as in \"{}\"", source,
                    row.id, form, row.text);
  }
  return out;
}

const std::vector<std::string>& language_codes() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> out{"en"};
    for (const auto& [file, text] : language_files()) out.push_back(std::filesystem::path(file).stem().string());
    return out;
  }();
  return all;
}

Result<void> use_language(const std::string& code_or_file) {
  if (code_or_file == "en") {
    present() = &english();
    return {};
  }
  std::unique_ptr<Language>& at = known()[code_or_file];
  const std::filesystem::path file(code_or_file);
  for (const auto& [name, text] : language_files())
    if (!at && name == code_or_file + ".json") {
      DUBSAR_ASSIGN(Language made, Language::parse(code_or_file, text, name));
      at = std::make_unique<Language>(std::move(made));
    }
  if (!at && file.extension() == ".json") {
    DUBSAR_ASSIGN(const std::string text, read_text_file(file));
    DUBSAR_ASSIGN(Language made, Language::parse(file.stem().string(), text, code_or_file));
    at = std::make_unique<Language>(std::move(made));
  }
  if (!at)
    return fail(ErrorKind::kUsage, "\"{}\" is no language, expected one of {} or a file of texts such as fr.json",
                code_or_file, fmt::join(language_codes(), ", "));
  present() = at.get();
  return {};
}

const Language& language() { return *present(); }

std::string language_of_locale(std::string_view locale) {
  const std::string code(locale.substr(0, locale.find_first_of("_.@")));
  const auto& all = language_codes();
  return std::find(all.begin(), all.end(), code) == all.end() ? "en" : code;
}

const std::string& text_of(const Text& text) {
  static const std::string none;
  return text.empty() ? none : language()[text];
}

std::string filled(const std::string& text, std::span<const std::string> values) {
  const std::vector<std::string> forms = forms_of(text);
  long long count = 0;
  if (forms.size() > 1) std::from_chars(values[0].data(), values[0].data() + values[0].size(), count);
  const std::string& form = forms[forms.size() > 1 ? std::min(language().form(count), forms.size() - 1) : 0];
  std::string out;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool place = form[i] == '{' && i + 2 < form.size() && form[i + 2] == '}';
    const auto which = place ? static_cast<std::size_t>(form[i + 1] - '0') : values.size();
    if (which >= values.size()) {
      out += form[i];
      continue;
    }
    out += values[which];
    i += 2;
  }
  return out;
}

std::string tr_name(std::string_view family, std::string_view name) {
  std::string id = fmt::format("{}.{}", family, lower_text(name));
  std::replace(id.begin(), id.end(), ' ', '_');
  const Text text = Text::find(id);
  return text.empty() ? std::string(name) : tr(text);
}

std::string local_figures(std::string text) {
  const std::string& sign = tr("language.decimal");
  const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  for (std::size_t i = 1; sign != "." && i < text.size(); ++i)
    if (text[i] == '.' && digit(i - 1) && digit(i + 1)) text.replace(i, 1, sign);
  return text;
}

}  // namespace dubsar::app
