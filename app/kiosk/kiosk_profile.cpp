#include "app/kiosk/kiosk_profile.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr std::string_view kProfileFormat = "dubsar kiosk";
constexpr std::size_t kMostObjects = 64, kMostTexts = 32, kMostPanels = 4;

constexpr std::array<std::string_view, 19> kMembers{
    "format",       "version", "objects",      "languages",       "words",  "display",    "monitor",
    "panels",       "inputs",  "idle_reset_s", "attract_after_s", "quiet",  "brightness", "reading_distance_m",
    "parallax_deg", "pin",     "key_file",     "journal",         "comment"};
constexpr std::array<std::string_view, 3> kPanelMembers{"display", "monitor", "size"};
constexpr std::array<std::string_view, 5> kObjectMembers{"file", "tour", "title", "parts", "style"};

/// Reads, and keeps the first thing wrong.
class Reader {
 public:
  Reader(std::string source, const std::filesystem::path& folder) : source_(std::move(source)), folder_(folder) {}

  void only(const json& object, std::span<const std::string_view> known, std::string_view where) {
    for (const auto& [name, value] : object.items())
      if (std::find(known.begin(), known.end(), std::string_view(name)) == known.end())
        complain(fmt::format("{}\"{}\" is unknown", where, name));
  }
  std::vector<std::string> strings(const json& object, const char* name, std::size_t most) {
    std::vector<std::string> out;
    if (!object.contains(name)) return out;
    const json& list = object.at(name);
    if (!list.is_array() || list.size() > most) {
      complain(fmt::format("\"{}\" is no list of at most {} texts", name, most));
      return out;
    }
    for (const json& item : list) {
      if (item.is_string() && !item.get_ref<const std::string&>().empty())
        out.push_back(item.get<std::string>());
      else
        complain(fmt::format("\"{}\" holds something that is no text", name));
    }
    return out;
  }
  Texts texts(const json& object, const char* name) {
    Texts out;
    if (!object.contains(name)) return out;
    const json& value = object.at(name);
    if (value.is_string()) return {{"en", value.get<std::string>()}};
    if (!value.is_object() || value.size() > kMostTexts) {
      complain(fmt::format("\"{}\" is neither a text nor texts by language", name));
      return out;
    }
    for (const auto& [language, text] : value.items()) {
      if (text.is_string())
        out[language] = text.get<std::string>();
      else
        complain(fmt::format("\"{}\" in {} is no text", name, language));
    }
    return out;
  }
  std::filesystem::path path(const std::string& text) const {
    return text.empty() ? std::filesystem::path() : folder_ / text;  // an absolute one stays
  }
  void complain(std::string sentence) {
    if (complaint_.empty()) complaint_ = std::move(sentence);
  }
  Result<void> finish() const {
    if (complaint_.empty()) return {};
    return fail(ErrorKind::kConfig, "{}: {}", source_, complaint_);
  }

 private:
  std::string source_, complaint_;
  const std::filesystem::path& folder_;
};

KioskObject read_object(Reader& reader, const json& object, std::size_t index) {
  KioskObject out;
  const std::string where = fmt::format("objects[{}]: ", index);
  if (!object.is_object()) {
    reader.complain(where + "no object found, expected {\"file\": \"tablet.exa\"}");
    return out;
  }
  reader.only(object, kObjectMembers, where);
  JsonFields fields(object, fmt::format("objects[{}]", index));
  out.file = reader.path(fields.text("file", ""));
  if (out.file.empty()) reader.complain(where + "\"file\" is missing, expected a surface such as tablet.exa");
  const std::string tour = fields.text("tour", "");
  out.toured = tour != "none";
  if (out.toured) out.tour = reader.path(tour);
  out.style = fields.text("style", out.style.c_str());
  out.parts = reader.strings(object, "parts", 8);
  out.title = reader.texts(object, "title");
  if (const auto done = fields.finish(); !done) reader.complain(done.error().message);
  return out;
}

KioskPanel read_panel(Reader& reader, const json& object, std::size_t index) {
  KioskPanel out;
  const std::string where = fmt::format("panels[{}]: ", index);
  if (!object.is_object()) {
    reader.complain(where + "no panel found, expected {\"display\": \"anaglyph\", \"monitor\": \"HDMI-2\"}");
    return out;
  }
  reader.only(object, kPanelMembers, where);
  JsonFields fields(object, fmt::format("panels[{}]", index));
  out.display = fields.text("display", "mono");
  out.monitor = fields.text("monitor", "");
  out.size = fields.text("size", "");
  if (out.monitor.empty() && out.size.empty())
    reader.complain(where + "neither \"monitor\" nor \"size\" is given: it would stand before the first panel");
  if (const auto done = fields.finish(); !done) reader.complain(done.error().message);
  return out;
}

bool is_pin(std::string_view text) {
  return text.size() >= 4 && text.size() <= 12 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Result<void> check_there(const std::filesystem::path& file, std::string_view source, std::string_view what) {
  std::error_code error;
  if (file.empty() || std::filesystem::is_regular_file(file, error)) return {};
  return fail(ErrorKind::kConfig, "{}: {} {} is not there, expected a file", source, what, file.string());
}

}  // namespace

Result<KioskProfile> parse_kiosk_profile(std::string_view json_text, std::string_view source,
                                         const std::filesystem::path& folder) {
  auto parsed = parse_json(json_text, source);
  if (!parsed) return fail(ErrorKind::kConfig, "{}", parsed.error().message);
  const json& object = *parsed;
  if (const auto version = json_version(object, kProfileFormat, 1, 1, source); !version)
    return fail(ErrorKind::kConfig, "{}", version.error().message);
  Reader reader{std::string(source), folder};
  reader.only(object, kMembers, "");
  KioskProfile out;
  if (!object.contains("objects") || !object.at("objects").is_array() || object.at("objects").empty() ||
      object.at("objects").size() > kMostObjects)
    reader.complain(fmt::format("\"objects\" is no list of 1 to {} objects", kMostObjects));
  else
    for (const json& item : object.at("objects")) out.objects.push_back(read_object(reader, item, out.objects.size()));
  if (object.contains("panels")) {
    if (!object.at("panels").is_array() || object.at("panels").size() > kMostPanels)
      reader.complain(fmt::format("\"panels\" is no list of at most {} panels", kMostPanels));
    else
      for (const json& item : object.at("panels")) out.panels.push_back(read_panel(reader, item, out.panels.size()));
  }
  if (object.contains("languages")) out.languages = reader.strings(object, "languages", 16);
  if (out.languages.empty()) reader.complain("\"languages\" names none");
  out.inputs = reader.strings(object, "inputs", 16);
  for (const std::string& hours : reader.strings(object, "quiet", 16)) {
    const auto quiet = parse_quiet_hours(hours);
    if (quiet)
      out.quiet.push_back(*quiet);
    else
      reader.complain(quiet.error().message);
  }
  JsonFields fields(object, "the profile");
  out.words = reader.path(fields.text("words", ""));
  out.display = fields.text("display", out.display.c_str());
  out.monitor = fields.text("monitor", "");
  out.idle_reset_s = fields.number("idle_reset_s", 5, 3600, &out.idle_reset_s);
  out.attract_after_s = fields.number("attract_after_s", 1, 3600, &out.attract_after_s);
  out.brightness = fields.number("brightness", 0.1, 1.0, &out.brightness);
  out.eyes.reading_distance_m = fields.number("reading_distance_m", 0.3, 10.0, &out.eyes.reading_distance_m);
  out.eyes.parallax_deg = fields.number("parallax_deg", 0.1, 3.0, &out.eyes.parallax_deg);
  out.pin = fields.text("pin", "");
  out.key_file = reader.path(fields.text("key_file", ""));
  out.journal = reader.path(fields.text("journal", ""));
  if (!out.pin.empty() && !is_pin(out.pin)) reader.complain("\"pin\" is no text of 4 to 12 digits");
  if (out.pin.empty() && out.key_file.empty())
    reader.complain("neither \"pin\" nor \"key_file\" is given: nobody could end it");
  if (const auto done = fields.finish(); !done) reader.complain(done.error().message);
  DUBSAR_TRY(reader.finish());
  return out;
}

Result<KioskProfile> read_kiosk_profile(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path));
  const std::string source = path.string();
  DUBSAR_ASSIGN(KioskProfile out, parse_kiosk_profile(text, source, path.parent_path()));
  for (const KioskObject& object : out.objects) {
    DUBSAR_TRY(check_there(object.file, source, "the surface"));
    DUBSAR_TRY(check_there(object.tour, source, "the tour"));
  }
  DUBSAR_TRY(check_there(out.words, source, "the file of words"));
  return out;
}

std::string_view text_in(const Texts& texts, std::string_view language) noexcept {
  if (const auto found = texts.find(language); found != texts.end()) return found->second;
  if (const auto found = texts.find("en"); found != texts.end()) return found->second;
  return texts.empty() ? std::string_view() : std::string_view(texts.begin()->second);
}

}  // namespace dubsar::app
