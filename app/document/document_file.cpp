#include "app/document/document_file.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::string_view kFormat = "dubsar document";
constexpr double kLargest = 1e6;  // mm, degrees, seconds: nothing of a scan is larger
constexpr std::size_t kMostThings = 10'000, kLongestText = 100'000;
constexpr TimestampNs kEveryNs = 10'000'000'000;

class Writer {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    out_[name] = write(value);
  }
  json take() { return std::move(out_); }

 private:
  static json write(const std::string& text) { return text; }
  static json write(bool value) { return value; }
  static json write(double value) { return value; }
  static json write(int value) { return value; }
  static json write(std::int64_t value) { return value; }
  static json write(std::uint8_t value) { return static_cast<int>(value); }
  static json write(const std::array<std::uint8_t, 3>& v) { return {int{v[0]}, int{v[1]}, int{v[2]}}; }
  static json write(const glm::dvec2& v) { return {v.x, v.y}; }
  static json write(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
  static json write(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }
  template <class T>
  static json write(const std::vector<T>& things) {
    json out = json::array();
    for (const T& thing : things) out.push_back(write(thing));
    return out;
  }
  template <class T>
  static json write(const T& thing) {
    Writer inner;
    T copy = thing;
    fields(inner, copy);
    return inner.take();
  }
  json out_ = json::object();
};

/// The first thing wrong is kept; what cannot be read stays as it was.
class Reader {
 public:
  Reader(const json& object, std::string where, std::string& complaint)
      : object_(object), where_(std::move(where)), complaint_(complaint) {}

  template <class T>
  void operator()(const char* name, T& value) {
    const std::string at = where_.empty() ? name : where_ + "." + name;
    if (!object_.is_object() || !object_.contains(name)) return complain(at + " is missing");
    read(object_.at(name), at, value);
  }

 private:
  void complain(std::string sentence) const {
    if (complaint_.empty()) complaint_ = std::move(sentence);
  }
  double real(const json& value, const std::string& at, double low, double high) const {
    const double found = value.is_number() ? value.get<double>() : NAN;
    if (found >= low && found <= high) return found;
    complain(fmt::format("{} is no number of {} to {}", at, low, high));
    return low;
  }
  void numbers(const json& value, const std::string& at, std::span<double> out) const {
    if (!value.is_array() || value.size() != out.size())
      return complain(fmt::format("{} is no list of {} numbers", at, out.size()));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = real(value[i], at, -kLargest, kLargest);
  }
  void read(const json& value, const std::string& at, std::string& out) const {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestText)
      return complain(fmt::format("{} is no text of at most {} letters", at, kLongestText));
    out = value.get<std::string>();
  }
  void read(const json& value, const std::string& at, bool& out) const {
    if (!value.is_boolean()) return complain(at + " is not true or false");
    out = value.get<bool>();
  }
  void read(const json& value, const std::string& at, double& out) const { out = real(value, at, -kLargest, kLargest); }
  void read(const json& value, const std::string& at, int& out) const {
    out = static_cast<int>(real(value, at, -kLargest, kLargest));
  }
  void read(const json& value, const std::string& at, std::int64_t& out) const {
    if (!value.is_number_integer()) return complain(at + " is no whole number");
    out = value.get<std::int64_t>();
  }
  void read(const json& value, const std::string& at, std::uint8_t& out) const {
    out = static_cast<std::uint8_t>(real(value, at, 0, 255));
  }
  void read(const json& value, const std::string& at, std::array<std::uint8_t, 3>& out) const {
    if (!value.is_array() || value.size() != 3) return complain(at + " is no list of 3 numbers");
    for (std::size_t i = 0; i < 3; ++i) read(value[i], at, out[i]);
  }
  void read(const json& value, const std::string& at, glm::dvec2& out) const {
    std::array<double, 2> v{};
    numbers(value, at, v);
    out = {v[0], v[1]};
  }
  void read(const json& value, const std::string& at, glm::dvec3& out) const {
    std::array<double, 3> v{};
    numbers(value, at, v);
    out = {v[0], v[1], v[2]};
  }
  void read(const json& value, const std::string& at, glm::dquat& out) const {
    std::array<double, 4> v{1, 0, 0, 0};
    numbers(value, at, v);
    const glm::dquat q(v[0], v[1], v[2], v[3]);
    if (!(std::abs(glm::length(q) - 1.0) <= 1e-6)) return complain(at + " is no turn: its length is not 1");
    out = q;
  }
  template <class T>
  void read(const json& value, const std::string& at, std::vector<T>& out) const {
    if (!value.is_array() || value.size() > kMostThings)
      return complain(fmt::format("{} is no list of at most {} things", at, kMostThings));
    out.assign(value.size(), T());
    for (std::size_t i = 0; i < value.size() && complaint_.empty(); ++i)
      read(value[i], fmt::format("{}[{}]", at, i), out[i]);
  }
  template <class T>
  void read(const json& value, const std::string& at, T& out) const {
    Reader inner(value, at, complaint_);
    fields(inner, out);
  }
  const json& object_;
  std::string where_;
  std::string& complaint_;
};

// What each thing consists of, once for both ways.
void fields(auto& f, SourceFile& v) {
  f("path", v.path);
  f("bytes", v.bytes);
}
void fields(auto& f, Part& v) {
  f("name", v.name);
  f("partitions", v.partitions);
  f("visible", v.visible);
  f("colour", v.colour);
  f("opacity", v.opacity);
  f("offset_mm", v.offset_mm);
}
void fields(auto& f, CameraPose& v) {
  f("rotation_wxyz", v.rotation);
  f("zoom", v.zoom);
  f("pan", v.pan);
}
void fields(auto& f, LightPlace& v) {
  f("azimuth_deg", v.azimuth_deg);
  f("elevation_deg", v.elevation_deg);
}
void fields(auto& f, StyleChoice& v) {
  f("name", v.name);
  f("strength", v.strength);
  f("occlusion", v.occlusion);
}
void fields(auto& f, Cut& v) {
  f("normal", v.normal);
  f("distance_mm", v.distance_mm);
  f("on", v.on);
}
void fields(auto& f, Measure& v) {
  f("name", v.name);
  f("points_mm", v.points_mm);
}
void fields(auto& f, Note& v) {
  f("text", v.text);
  f("at_mm", v.at_mm);
  f("normal", v.normal);
  f("camera", v.camera);
}
void fields(auto& f, SliceView& v) {
  f("axis", v.axis);
  f("position_mm", v.position_mm);
  f("visible", v.visible);
}
void fields(auto& f, Keyframe& v) {
  f("time_s", v.time_s);
  f("camera", v.camera);
  f("light", v.light);
  f("unpack", v.unpack);
}
void fields(auto& f, Document& v) {
  f("source", v.source);
  f("parts", v.parts);
  f("unpack", v.unpack);
  f("home", v.home);
  f("now", v.now);
  f("home_light", v.home_light);
  f("light", v.light);
  f("style", v.style);
  f("clips", v.clips);
  f("measures", v.measures);
  f("notes", v.notes);
  f("slices", v.slices);
  f("keyframes", v.keyframes);
}

/// What ranges alone do not say.
std::string complaint_about(const Document& d) {
  for (const CameraPose* camera : {&d.home, &d.now})
    if (!(camera->zoom > 0)) return fmt::format("zoom is {}, expected more than 0", camera->zoom);
  if (!(d.unpack >= 0 && d.unpack <= 1)) return fmt::format("unpack is {}, expected 0 to 1", d.unpack);
  if (!(d.style.strength >= 0 && d.style.strength <= 2))
    return fmt::format("style.strength is {}, expected 0 to 2", d.style.strength);
  for (const Part& part : d.parts)
    if (!(part.opacity >= 0 && part.opacity <= 1))
      return fmt::format("opacity of {} is {}, expected 0 to 1", part.name, part.opacity);
  for (const SliceView& slice : d.slices)
    if (slice.axis < 0 || slice.axis > 2) return fmt::format("axis is {}, expected 0, 1 or 2", slice.axis);
  return {};
}

}  // namespace

std::string format_document(const Document& document) {
  Document copy = document;
  Writer writer;
  fields(writer, copy);
  json out = writer.take();
  out["format"] = kFormat;
  out["version"] = kVersion;
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Document> parse_document(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(text, source));
  if (!object.is_object() || !object.contains("format") || object.at("format") != kFormat)
    return fail(ErrorKind::kBadData, "{}: found other JSON, expected \"format\": \"{}\"", source, kFormat);
  if (!object.contains("version") || object.at("version") != kVersion)
    return fail(ErrorKind::kBadData, "{}: version {} found, expected {}; a newer dubsar may have written it", source,
                object.contains("version") ? dump_json(object.at("version")) : "none", kVersion);
  Document out;
  std::string complaint;
  Reader reader(object, "", complaint);
  fields(reader, out);
  if (complaint.empty()) complaint = complaint_about(out);
  if (!complaint.empty()) return fail(ErrorKind::kBadData, "{}: {}", source, complaint);
  return out;
}

Result<void> save_document(const std::filesystem::path& path, const Document& document) {
  return write_file_atomically(path, format_document(document));
}

Result<Document> load_document(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path));
  return parse_document(text, path.string());
}

std::filesystem::path Autosave::file_for(const std::filesystem::path& folder, const SourceFile& source) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a: names of any length and alphabet become file names
  for (const char c : source.path) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return folder / fmt::format("{:016x}.json", hash);
}

bool Autosave::has_left_behind() const {
  std::error_code error;
  return !file_.empty() && std::filesystem::exists(file_, error);
}

Result<Document> Autosave::left_behind(const SourceFile& source) const {
  DUBSAR_ASSIGN(Document found, load_document(file_));
  if (found.source != source)
    return fail(ErrorKind::kBadData, "{}: notes on {} of {} bytes found, expected {} of {} bytes", file_.string(),
                found.source.path, found.source.bytes, source.path, source.bytes);
  return found;
}

Result<void> Autosave::keep(TimestampNs now, const Document& document) {
  if (file_.empty() || (any_ && (now < next_ || document == written_))) return {};
  if (!any_) {  // what it begins with is not work yet
    any_ = true;
    written_ = document;
    return {};
  }
  next_ = now + kEveryNs;
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  DUBSAR_TRY(save_document(file_, document));
  written_ = document;
  return {};
}

void Autosave::discard() {
  std::error_code error;
  if (!file_.empty()) std::filesystem::remove(file_, error);
}

}  // namespace dubsar::app
