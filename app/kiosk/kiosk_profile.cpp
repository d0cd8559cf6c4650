#include "app/kiosk/kiosk_profile.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_fault.h"
#include "core/base/text/json_places.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr std::string_view kProfileFormat = "dubsar kiosk";
constexpr std::size_t kMostObjects = 64, kMostPanels = 4;

constexpr std::array<std::string_view, 20> kMembers{
    "format",       "version", "objects",      "languages",       "words",   "display",    "monitor",
    "panels",       "inputs",  "idle_reset_s", "attract_after_s", "quiet",   "brightness", "reading_distance_m",
    "parallax_deg", "pin",     "key_file",     "journal",         "comment", "plugins"};
constexpr std::array<std::string_view, 3> kPanelMembers{"display", "monitor", "size"};
constexpr std::array<std::string_view, 5> kObjectMembers{"file", "tour", "title", "parts", "style"};

std::filesystem::path in_folder(const std::filesystem::path& folder, const std::string& text) {
  return text.empty() ? std::filesystem::path() : folder / text;  // an absolute one stays
}

/// What the fields of the thing at `place` complain of, each at its own place.
void tell(const JsonFields& fields, const std::string& place, std::vector<ProfileFault>& faults) {
  const std::string_view said = fields.where();
  for (const JsonFields::Complaint& complaint : fields.complaints())
    faults.push_back({place + (complaint.member.empty() ? "" : "/" + complaint.member),
                      fmt::format("{}{}{}", said, said.empty() ? "" : ": ", complaint.sentence)});
}

KioskObject read_object(const json& object, const std::string& where, const std::string& place,
                        const std::filesystem::path& folder, std::vector<ProfileFault>& faults) {
  JsonFields fields(object, where);
  fields.only(kObjectMembers);
  KioskObject out;
  out.file = in_folder(folder, fields.text("file", ""));
  if (out.file.empty()) fields.complain("\"file\" is missing, expected a surface such as tablet.exa", "file");
  const std::string tour = fields.text("tour", "");
  out.toured = tour != "none";
  if (out.toured) out.tour = in_folder(folder, tour);
  out.style = fields.text("style", out.style.c_str());
  out.parts = fields.texts("parts", 8);
  out.title = read_texts(fields, object, "title");
  tell(fields, place, faults);
  return out;
}

KioskPanel read_panel(const json& object, const std::string& where, const std::string& place,
                      std::vector<ProfileFault>& faults) {
  JsonFields fields(object, where);
  fields.only(kPanelMembers);
  KioskPanel out;
  out.display = fields.text("display", "mono");
  out.monitor = fields.text("monitor", "");
  out.size = fields.text("size", "");
  if (out.monitor.empty() && out.size.empty())
    fields.complain("neither \"monitor\" nor \"size\" is given: it would stand before the first panel");
  tell(fields, place, faults);
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

Texts read_texts(JsonFields& fields, const json& object, const char* name) {
  constexpr std::size_t kMostTexts = 32, kLongestText = 400;
  Texts out;
  if (!fields.has(name)) return out;
  const json& value = object.at(name);
  const json by_language = value.is_string() ? json{{"en", value}} : value;
  if (!by_language.is_object() || by_language.size() > kMostTexts)
    fields.complain(fmt::format("\"{}\" is neither a text nor texts by language", name), name);
  else
    for (const auto& [language, text] : by_language.items()) {
      if (text.is_string() && text.get_ref<const std::string&>().size() <= kLongestText)
        out[language] = text.get<std::string>();
      else
        fields.complain(fmt::format("\"{}\" in {} is no text of at most {} bytes", name, language, kLongestText),
                        std::string(name) + "/" + language);
    }
  return out;
}

KioskProfile take_kiosk_profile(const json& object, const std::filesystem::path& folder,
                                std::vector<ProfileFault>& faults) {
  KioskProfile out;
  if (const auto version = json_version(object, kProfileFormat, 1, 1, "a kiosk's profile"); !version) {
    faults.push_back({object.is_object() && object.contains("format") ? "/version" : "", version.error().message});
    return out;
  }
  JsonFields fields(object, {});
  fields.only(kMembers);
  if (const auto done = check_list(object, "objects", 1, kMostObjects, ""); !done)
    fields.complain(fmt::format("\"objects\" is no list of 1 to {} objects", kMostObjects), "objects");
  else
    for (const json& item : object.at("objects")) {
      const std::size_t at = out.objects.size();
      out.objects.push_back(
          read_object(item, fmt::format("object {}", at + 1), fmt::format("/objects/{}", at), folder, faults));
    }
  for (const json& item : fields.list("panels", kMostPanels)) {
    const std::size_t at = out.panels.size();
    out.panels.push_back(read_panel(item, fmt::format("panel {}", at + 1), fmt::format("/panels/{}", at), faults));
  }
  if (fields.has("languages")) out.languages = fields.texts("languages", 16);
  if (out.languages.empty()) fields.complain("\"languages\" names none, expected such as [\"en\"]", "languages");
  out.inputs = fields.texts("inputs", 16);
  const std::vector<std::string> quiet = fields.texts("quiet", 16);
  for (std::size_t i = 0; i < quiet.size(); ++i) {
    const auto hours = parse_quiet_hours(quiet[i]);
    if (hours)
      out.quiet.push_back(*hours);
    else
      fields.complain(hours.error().message, fmt::format("quiet/{}", i));
  }
  for (const std::string& file : fields.texts("plugins", 16)) out.plugins.push_back(in_folder(folder, file).string());
  out.words = in_folder(folder, fields.text("words", ""));
  out.display = fields.text("display", out.display.c_str());
  out.monitor = fields.text("monitor", "");
  out.idle_reset_s = fields.number("idle_reset_s", 5, 3600, &out.idle_reset_s);
  out.attract_after_s = fields.number("attract_after_s", 1, 3600, &out.attract_after_s);
  out.brightness = fields.number("brightness", 0.1, 1.0, &out.brightness);
  out.eyes.reading_distance_m = fields.number("reading_distance_m", 0.3, 10.0, &out.eyes.reading_distance_m);
  out.eyes.parallax_deg = fields.number("parallax_deg", 0.1, 3.0, &out.eyes.parallax_deg);
  out.pin = fields.text("pin", "");
  out.key_file = in_folder(folder, fields.text("key_file", ""));
  out.journal = in_folder(folder, fields.text("journal", ""));
  if (!out.pin.empty() && !is_pin(out.pin)) fields.complain("\"pin\" is no text of 4 to 12 digits", "pin");
  if (out.pin.empty() && out.key_file.empty())
    fields.complain("neither \"pin\" nor \"key_file\" is given: nobody could end it");
  tell(fields, "", faults);
  return out;
}

Result<KioskProfile> parse_kiosk_profile(std::string_view json_text, std::string_view source,
                                         const std::filesystem::path& folder) {
  const auto parsed = parse_json(json_text, source);
  if (!parsed) return fail(ErrorKind::kConfig, "{}", parsed.error().message);
  std::vector<ProfileFault> faults;
  KioskProfile out = take_kiosk_profile(*parsed, folder, faults);
  if (faults.empty()) return out;
  return fail(ErrorKind::kConfig, "{}, {}: {}", source,
              json_place(json_text, JsonPlaces(json_text).at(faults.front().place)), faults.front().what);
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
