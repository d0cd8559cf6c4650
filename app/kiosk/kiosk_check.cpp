#include "app/kiosk/kiosk_check.h"

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_mend.h"
#include "core/base/text/json_places.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
using nlohmann::json;

struct CheckedFile {
  std::string name, given{};
  MendedJson mended{};
  JsonPlaces places{""};
  json value{};  ///< null: it cannot be read
};

namespace {

constexpr int kMinutesOfDay = 24 * 60;

/// The place that an error of a reader names in its own words: "steps[1]: keyframes[0].unpack is 4".
std::string place_in(const json& whole, std::string_view words) {
  const auto is_part = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::string out;
  const json* here = &whole;
  for (std::size_t i = 0; i < words.size();) {
    std::size_t end = i;
    while (end < words.size() && is_part(words[end])) ++end;
    const std::string word(words.substr(i, end - i));
    const bool number =
        i > 0 && words[i - 1] == '[' && !word.empty() && word.find_first_not_of("0123456789") == word.npos;
    if (here->is_object() && here->contains(word)) {
      out += "/" + word;
      here = &here->at(word);
    } else if (number && here->is_array() && word.size() < 6 && std::stoul(word) < here->size()) {
      out += "/" + word;
      here = &here->at(std::stoul(word));
    }
    i = std::max(end, i + 1);
  }
  return out;
}

/// Without the name of its file.
std::string without(const std::string& sentence, const std::string& name) {
  return sentence.starts_with(name + ": ") ? sentence.substr(name.size() + 2) : sentence;
}

/// A path as other systems write it.
bool is_foreign(const std::filesystem::path& path) {
  const std::string text = path.filename().string();
  return text.find('\\') != std::string::npos ||
         (text.size() > 2 && text[1] == ':' && std::isalpha(static_cast<unsigned char>(text[0])) != 0);
}

bool can_be_written(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path there = std::filesystem::absolute(folder, error);
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  return std::filesystem::is_directory(there, error) && ::access(there.c_str(), W_OK | X_OK) == 0;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

KioskCheck::~KioskCheck() = default;

std::size_t KioskCheck::open(const std::filesystem::path& path, ErrorKind kind) {
  const std::size_t index = files_.size();
  files_.push_back(std::make_unique<CheckedFile>());
  CheckedFile& file = *files_.back();
  file.name = path.string();
  auto text = read_text_file(path);
  if (!text) {
    faults_.push_back({index, std::string::npos, text.error().message, text.error().kind});
    return index;
  }
  file.given = *std::move(text);
  file.mended = mend_json(file.given);
  for (const JsonFault& fault : file.mended.faults) faults_.push_back({index, fault.at, fault.what, kind});
  if (!file.mended.whole) return index;
  auto value = parse_json(file.mended.text, file.name);
  if (!value) {
    faults_.push_back({index, 0, without(value.error().message, file.name), kind});
    return index;
  }
  file.value = *std::move(value);
  file.places = JsonPlaces(file.mended.text);
  for (const std::string& place : file.places.repeated())
    add(place,
        fmt::format("\"{}\" is there twice and the last one counts; take one out", place.substr(place.rfind('/') + 1)),
        kind, index);
  return index;
}

void KioskCheck::add(const std::string& place, std::string what, ErrorKind kind, std::size_t file) {
  const std::size_t at = files_[file]->places.at(place);
  if (files_[file]->mended.mended_in(at, files_[file]->places.end(place))) return;  // that it is no JSON was said
  faults_.push_back({file, files_[file]->mended.given_at(at), std::move(what), kind});
}

bool KioskCheck::there(const std::filesystem::path& path, const std::string& place, std::string_view what) {
  std::error_code error;
  if (path.empty() || std::filesystem::is_regular_file(path, error)) return !path.empty();
  if (is_foreign(path))
    add(place, fmt::format("a path of Windows found ({}), expected a file beside the profile such as tablet.exa",
                           path.filename().string()));
  else
    add(place,
        fmt::format("{} {} is not there; expected a file, counted from the profile's folder", what, path.string()),
        ErrorKind::kNoInput);
  return false;
}

KioskCheck::KioskCheck(const std::filesystem::path& profile) {
  const std::size_t own = open(profile, ErrorKind::kConfig);
  if (files_[own]->value.is_null()) return;
  std::vector<ProfileFault> faults;
  profile_ = take_kiosk_profile(files_[own]->value, profile.parent_path(), faults);
  for (ProfileFault& fault : faults) add(fault.place, std::move(fault.what));
  if (there(profile_.words, "/words", "the file of words")) read_words(profile_.words);
  look_at_objects();
  look_at_languages();
  int dark = 0;
  for (int minute = 0; minute < kMinutesOfDay; ++minute) dark += is_quiet(profile_.quiet, minute) ? 1 : 0;
  if (dark == kMinutesOfDay)
    add("/quiet", "the panel is dark all day and night; expected hours between which it shines");
  if (!profile_.journal.empty() && !can_be_written(profile_.journal))
    add("/journal",
        fmt::format("the journal {} cannot be written; expected a folder of whoever runs the kiosk",
                    profile_.journal.string()),
        ErrorKind::kPermission);
}

void KioskCheck::look_at_objects() {
  std::set<std::string> seen;
  tour_files_.resize(profile_.objects.size());
  for (std::size_t i = 0; i < profile_.objects.size(); ++i) {
    const KioskObject& object = profile_.objects[i];
    const std::string place = fmt::format("/objects/{}", i);
    if (there(object.file, place + "/file", "the surface") &&
        !seen.insert(object.file.string() + "\n" + object.tour.string() + "\n" + listed(object.parts)).second)
      add(place + "/file", fmt::format("object {} is {} once more; take one out", i + 1, object.file.string()));
    if (there(object.tour, place + "/tour", "the tour")) tours_.push_back(read_tour_of(i));
    tours_.resize(i + 1);
    look_at_texts(object.title, place + "/title", 0);
  }
}

Tour KioskCheck::read_tour_of(std::size_t object) {
  const std::size_t file = tour_files_[object] = open(profile_.objects[object].tour, ErrorKind::kBadData);
  const json& value = files_[file]->value;
  if (value.is_null()) return {};
  const auto whole = parse_tour(files_[file]->mended.text, "tour");
  if (!whole && (!value.is_object() || !value.contains("steps") || !value.at("steps").is_array())) {
    add(place_in(value, whole.error().message), without(whole.error().message, "tour"), ErrorKind::kBadData, file);
  } else if (!whole) {  // each step by itself
    const std::size_t before = faults_.size();
    for (std::size_t i = 0; i < value.at("steps").size(); ++i) {
      json one = value;
      one["steps"] = json::array({value.at("steps")[i]});
      const auto step = parse_tour(dump_json(one), "tour");
      if (step) continue;
      std::string said = without(step.error().message, "tour");
      std::string place = place_in(one, said);
      if (place.starts_with("/steps/0")) place = fmt::format("/steps/{}{}", i, place.substr(8));
      if (said.starts_with("steps[0]: ")) said = fmt::format("step {}: {}", i + 1, said.substr(10));
      add(place, said, ErrorKind::kBadData, file);
    }
    if (faults_.size() == before) add("", without(whole.error().message, "tour"), ErrorKind::kBadData, file);
  }
  if (!whole) return {};
  for (std::size_t i = 0; i < whole->steps.size(); ++i) {
    const TourStep& step = whole->steps[i];
    const std::string place = fmt::format("/steps/{}", i);
    look_at_texts(step.title, place + "/title", file);
    look_at_texts(step.text, place + "/text", file);
    for (std::size_t l = 0; l < step.labels.size(); ++l)
      look_at_texts(step.labels[l].text, fmt::format("{}/labels/{}/text", place, l), file);
  }
  return *whole;
}

void KioskCheck::read_words(const std::filesystem::path& path) {
  const std::size_t file = open(path, ErrorKind::kConfig);
  const json& value = files_[file]->value;
  if (value.is_null()) return;
  if (auto whole = Words::parse(files_[file]->mended.text, "words")) {
    words_ = *std::move(whole);
    return;
  }
  const auto tell = [&](const json& part) {
    const auto read = Words::parse(dump_json(part), "words");
    if (!read)
      add(place_in(part, read.error().message), without(read.error().message, "words"), ErrorKind::kConfig, file);
    return read.has_value();
  };
  if (!value.is_object()) {
    tell(value);
    return;
  }
  json good = json::object();
  for (const auto& [language, lines] : value.items()) {
    if (!Words().has(language) || !lines.is_object()) {
      json part;
      part[language] = lines;
      if (tell(part)) good[language] = lines;
      continue;
    }
    for (const auto& [name, sentence] : lines.items()) {
      json part;
      part[language][name] = sentence;
      if (tell(part)) good[language][name] = sentence;
    }
  }
  if (auto rest = Words::parse(dump_json(good), "words")) words_ = *std::move(rest);
}

void KioskCheck::look_at_languages() {
  for (std::size_t i = 0; i < profile_.languages.size(); ++i)
    if (!words_.has(profile_.languages[i]))
      add(fmt::format("/languages/{}", i),
          fmt::format("language \"{}\" found, expected {}; a new one needs all {} lines in the file of words",
                      profile_.languages[i], listed(words_.languages()), kLineCount));
}

/// A visitor who reads one of the profile's languages gets its texts in it.
void KioskCheck::look_at_texts(const Texts& texts, const std::string& place, std::size_t file) {
  const std::vector<std::string>& spoken = profile_.languages;
  const ErrorKind kind = file == 0 ? ErrorKind::kConfig : ErrorKind::kBadData;
  for (const auto& [language, text] : texts)
    if (std::find(spoken.begin(), spoken.end(), language) == spoken.end() && !words_.has(language))
      add(place + "/" + language,
          fmt::format("a text in \"{}\", which is none of the profile's languages ({}); it is never seen", language,
                      listed(spoken)),
          kind, file);
  if (texts.empty() || (texts.size() == 1 && texts.begin()->first == "en")) return;  // said so to everybody
  for (const std::string& language : spoken)
    if (words_.has(language) && texts.find(language) == texts.end())
      add(place,
          fmt::format("no text in \"{}\"; add it, else \"{}\" is shown to who reads that language", language,
                      text_in(texts, language)),
          kind, file);
}

std::vector<KioskCheck::Said> KioskCheck::said() const {
  std::vector<Said> out;
  const auto take = [&](const Texts& texts, const std::string& place, std::size_t file, bool title) {
    const bool one = files_[file]->value.is_object() && texts.size() == 1 &&
                     files_[file]->places.at(place + "/" + texts.begin()->first) == files_[file]->places.at(place);
    for (const auto& [language, text] : texts) out.push_back({file, one ? place : place + "/" + language, text, title});
  };
  for (std::size_t i = 0; i < profile_.objects.size(); ++i) {
    take(profile_.objects[i].title, fmt::format("/objects/{}/title", i), 0, true);
    const std::vector<TourStep>& steps = tours_[i].steps;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      take(steps[s].title, fmt::format("/steps/{}/title", s), tour_files_[i], true);
      take(steps[s].text, fmt::format("/steps/{}/text", s), tour_files_[i], false);
    }
  }
  for (std::size_t file = 1; file < files_.size(); ++file)
    if (std::filesystem::path(files_[file]->name) == profile_.words && files_[file]->value.is_object())
      for (const auto& [language, lines] : files_[file]->value.items()) {
        if (!lines.is_object()) continue;
        for (const auto& [name, sentence] : lines.items())
          if (sentence.is_string()) out.push_back({file, "/" + language + "/" + name, sentence.get<std::string>()});
      }
  return out;
}

std::vector<std::string> KioskCheck::sentences() const {
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Fault& a, const Fault& b) { return a.file != b.file ? a.file < b.file : a.at < b.at; });
  std::vector<std::string> out;
  for (const Fault& fault : sorted) {
    const CheckedFile& file = *files_[fault.file];
    out.push_back(fault.at == std::string::npos
                      ? fault.what
                      : fmt::format("{}, {}: {}", file.name, json_place(file.given, fault.at), fault.what));
  }
  return out;
}

ErrorKind KioskCheck::kind() const {
  for (const ErrorKind kind : {ErrorKind::kConfig, ErrorKind::kNoInput, ErrorKind::kBadData, ErrorKind::kPermission})
    if (std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) { return fault.kind == kind; }))
      return kind;
  return faults_.empty() ? ErrorKind::kInternal : faults_.front().kind;
}

}  // namespace dubsar::app
