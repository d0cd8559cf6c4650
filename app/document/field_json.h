#pragma once
// Plain values to JSON and back: one list of members, fields(), serves both ways. Part of this room.

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/document.h"

namespace dubsar::app::stored {
using nlohmann::json;

inline constexpr double kLargest = 1e12;  // mm, degrees, seconds; places of georeferenced surfaces are some 1e9 mm

/// Places are kept to a micrometre, figures to a nanometre.
inline double rounded_mm(double mm) { return std::abs(mm) < kLargest ? std::round(mm * 1e3) / 1e3 : mm; }
inline double rounded_figure_mm(double mm) { return std::abs(mm) < 1e6 ? std::round(mm * 1e6) / 1e6 : mm; }

class Writer {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    out_[name] = std::string_view(name).ends_with("_mm") ? write(in_mm(value)) : write(value);
  }
  /// What has no value is not written.
  template <class T>
  void operator()(const char* name, const std::optional<T>& value) {
    if (value) operator()(name, *value);
  }
  json take() { return std::move(out_); }

 private:
  template <class T>
  static const T& in_mm(const T& v) {
    return v;
  }
  static double in_mm(double v) { return rounded_figure_mm(v); }
  static glm::dvec3 in_mm(const glm::dvec3& v) { return {rounded_mm(v.x), rounded_mm(v.y), rounded_mm(v.z)}; }
  static std::vector<glm::dvec3> in_mm(std::vector<glm::dvec3> points) {
    for (glm::dvec3& p : points) p = in_mm(p);
    return points;
  }
  static json write(const std::string& text) { return text; }
  static json write(bool value) { return value; }
  static json write(double value) { return value; }
  static json write(int value) { return value; }
  static json write(MeasureKind value) { return std::string(measure_kind_name(value)); }
  static json write(WedgeKind value) { return std::string(name_in(kWedgeKinds, value)); }
  static json write(TextSide value) { return std::string(name_in(kTextSides, value)); }
  static json write(WedgeBy value) { return std::string(name_in(kWedgeBys, value)); }
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
  /// `lenient`: of an older version, which knew fewer members; those that are missing stay as they are.
  Reader(const json& object, std::string where, std::string& complaint, bool lenient = false)
      : object_(object), where_(std::move(where)), complaint_(complaint), lenient_(lenient) {}

  template <class T>
  void operator()(const char* name, T& value) {
    const std::string at = where_.empty() ? name : where_ + "." + name;
    if (!object_.is_object() || !object_.contains(name)) {
      if (!lenient_ || !object_.is_object()) complain(at + " is missing");
      return;
    }
    read(object_.at(name), at, value);
  }
  /// What is missing has no value.
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    value.reset();
    if (object_.is_object() && object_.contains(name))
      read(object_.at(name), where_.empty() ? name : where_ + "." + name, value.emplace());
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
    if (!value.is_string()) return complain(at + " is no text");
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
  void read(const json& value, const std::string& at, MeasureKind& out) const {
    const auto found = value.is_string() ? measure_kind(value.get<std::string>()) : std::nullopt;
    if (!found) return complain(at + " is no kind of measure: distance, angle, depth or profile");
    out = *found;
  }
  template <class Enum, std::size_t kCount>
  void name(const json& value, const std::string& at, const EnumName<Enum> (&names)[kCount], Enum& out) const {
    for (const EnumName<Enum>& each : names)
      if (value.is_string() && value.get<std::string>() == each.name) {
        out = each.value;
        return;
      }
    complain(fmt::format("{} is none of its names, {} to {}", at, names[0].name, names[kCount - 1].name));
  }
  void read(const json& value, const std::string& at, WedgeKind& out) const { name(value, at, kWedgeKinds, out); }
  void read(const json& value, const std::string& at, TextSide& out) const { name(value, at, kTextSides, out); }
  void read(const json& value, const std::string& at, WedgeBy& out) const { name(value, at, kWedgeBys, out); }
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
    if (!value.is_array()) return complain(at + " is no list");
    out.assign(value.size(), T());
    for (std::size_t i = 0; i < value.size() && complaint_.empty(); ++i)
      read(value[i], fmt::format("{}[{}]", at, i), out[i]);
  }
  template <class T>
  void read(const json& value, const std::string& at, T& out) const {
    Reader inner(value, at, complaint_, lenient_);
    fields(inner, out);
  }
  const json& object_;
  std::string where_;
  std::string& complaint_;
  bool lenient_;
};

}  // namespace dubsar::app::stored
