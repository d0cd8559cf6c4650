#include "app/kiosk/tour.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr std::string_view kTourFormat = "dubsar tour";
constexpr std::size_t kMostSteps = 64, kMostLabels = 16, kMostKeys = 1000;
constexpr double kLongestS = 600.0;
constexpr std::array<std::string_view, 4> kTourMembers{"format", "version", "steps", "comment"};
constexpr std::array<std::string_view, 6> kStepMembers{"title", "text", "labels", "stays_s", "says_s", "keyframes"};
constexpr std::array<std::string_view, 4> kLabelMembers{"text", "part", "at_mm", "normal"};
constexpr std::array<std::string_view, 6> kKeyMembers{"time_s", "camera", "light", "unpack", "style", "parts"};
constexpr std::array<std::string_view, 3> kCameraMembers{"rotation_wxyz", "zoom", "pan"};
constexpr std::array<std::string_view, 2> kLightMembers{"azimuth_deg", "elevation_deg"};

Result<glm::dvec3> place(const json& object, const char* name, const glm::dvec3& otherwise, const std::string& where) {
  if (!object.contains(name)) return otherwise;
  const json& value = object.at(name);
  glm::dvec3 out{0.0};
  const bool three = value.is_array() && value.size() == 3 &&
                     std::all_of(value.begin(), value.end(), [](const json& number) { return number.is_number(); });
  if (!three) return fail(ErrorKind::kBadData, "{}: \"{}\" is no list of 3 numbers", where, name);
  for (int a = 0; a < 3; ++a) out[a] = value[static_cast<std::size_t>(a)].get<double>();
  return out;
}

Result<TourLabel> read_label(const json& object, const std::string& where) {
  JsonFields fields(object, where);
  fields.only(kLabelMembers);
  TourLabel out;
  out.text = read_texts(fields, object, "text");
  if (out.text.empty()) fields.complain("\"text\" is missing");
  out.part = fields.text("part", "");
  DUBSAR_TRY(fields.finish(ErrorKind::kBadData));
  if (!object.contains("at_mm")) return fail(ErrorKind::kBadData, "{}: \"at_mm\" is missing", where);
  DUBSAR_ASSIGN(out.at_mm, place(object, "at_mm", {}, where));
  DUBSAR_ASSIGN(out.normal, place(object, "normal", {0.0, 0.0, 1.0}, where));
  if (!(glm::length(out.normal) > 1e-6)) return fail(ErrorKind::kBadData, "{}: \"normal\" has no direction", where);
  out.normal = glm::normalize(out.normal);
  return out;
}

/// What is not said is as before: the text of a whole film, for parse_film().
Result<std::vector<Keyframe>> read_keys(const json& object, json& before, const std::string& where) {
  const auto read = [&](const json& key, const std::string& at) -> Result<json> {
    DUBSAR_TRY(check_members(key, kKeyMembers, at));
    if (key.contains("camera")) DUBSAR_TRY(check_members(key.at("camera"), kCameraMembers, at + ".camera"));
    if (key.contains("light")) DUBSAR_TRY(check_members(key.at("light"), kLightMembers, at + ".light"));
    before.merge_patch(key);
    json whole = before;
    before.erase("time_s");
    return whole;
  };
  DUBSAR_ASSIGN(std::vector<json> keys, read_list<json>(object, "keyframes", 0, kMostKeys, where, read));
  const json film{{"format", "dubsar film"}, {"version", 1}, {"keyframes", std::move(keys)}};
  DUBSAR_ASSIGN(std::vector<Keyframe> out, parse_film(dump_json(film), where));
  if (!(out.front().time_s > 0.0) || out.back().time_s > kLongestS)
    return fail(ErrorKind::kBadData, "{}: keyframes from {} to {} s found, expected times above 0, up to {}", where,
                out.front().time_s, out.back().time_s, kLongestS);
  return out;
}

Result<TourStep> read_step(const json& object, json& before, const std::string& where) {
  JsonFields fields(object, where);
  fields.only(kStepMembers);
  TourStep out;
  out.title = read_texts(fields, object, "title");
  out.text = read_texts(fields, object, "text");
  out.stays_s = fields.number("stays_s", 0.0, kLongestS, &out.stays_s);
  out.says_s = fields.number("says_s", 0.0, kLongestS, &out.says_s);
  DUBSAR_TRY(fields.finish(ErrorKind::kBadData));
  DUBSAR_ASSIGN(out.labels, read_list<TourLabel>(object, "labels", 0, kMostLabels, where, read_label));
  DUBSAR_ASSIGN(out.keyframes, read_keys(object, before, where));
  return out;
}

json json_of(const TourLabel& label) {
  return {{"text", label.text},
          {"part", label.part},
          {"at_mm", {label.at_mm.x, label.at_mm.y, label.at_mm.z}},
          {"normal", {label.normal.x, label.normal.y, label.normal.z}}};
}

}  // namespace

Result<Tour> parse_tour(std::string_view json_text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(json_text, source));
  DUBSAR_TRY(json_version(object, kTourFormat, 1, 1, source));
  DUBSAR_TRY(check_members(object, kTourMembers, std::string(source)));
  Tour out;
  json before{{"camera", {{"rotation_wxyz", {1, 0, 0, 0}}, {"zoom", 1}, {"pan", {0, 0}}}},
              {"light", {{"azimuth_deg", LightPlace().azimuth_deg}, {"elevation_deg", LightPlace().elevation_deg}}},
              {"unpack", 0},
              {"style", ""},
              {"parts", json::array()}};
  const auto read = [&](const json& step, const std::string& where) { return read_step(step, before, where); };
  DUBSAR_ASSIGN(out.steps, read_list<TourStep>(object, "steps", 1, kMostSteps, std::string(source), read));
  return out;
}

Result<Tour> read_tour(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path));
  return parse_tour(text, path.string());
}

std::string format_tour(const Tour& tour) {
  json out{{"format", kTourFormat}, {"version", 1}, {"steps", json::array()}};
  for (const TourStep& step : tour.steps) {
    json one{{"title", step.title}, {"text", step.text}, {"stays_s", step.stays_s}};
    if (step.says_s > 0.0) one["says_s"] = step.says_s;
    if (!step.labels.empty()) one["labels"] = json::array();
    for (const TourLabel& label : step.labels) one["labels"].push_back(json_of(label));
    one["keyframes"] = json::parse(format_film(step.keyframes)).at("keyframes");
    out["steps"].push_back(std::move(one));
  }
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

double step_length_s(const TourStep& step) { return step.keyframes.back().time_s + step.stays_s; }

}  // namespace dubsar::app
