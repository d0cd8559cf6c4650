#pragma once
// Reads fields of a JSON object with their ranges; the first thing wrong becomes one sentence.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

class JsonFields {
 public:
  /// Borrows `object`. `where` starts the sentence, e.g. "profile looking-glass-go in user.json".
  JsonFields(const nlohmann::json& object, std::string where) : object_(&object), where_(std::move(where)) {}

  /// A number in [low, high], bare or wrapped as {"value": x}. Missing: `fallback`, or an error when it is null.
  double number(const char* name, double low, double high, const double* fallback = nullptr);
  int integer(const char* name, int low, int high, const int* fallback = nullptr);
  /// true, false, or a number (>= 0.5 is true), bare or wrapped.
  bool flag(const char* name, bool fallback);
  std::string text(const char* name, const char* fallback);

  bool has(const char* name) const { return object_->is_object() && object_->contains(name); }
  const std::string& where() const noexcept { return where_; }
  void complain(std::string sentence);
  /// The first complaint, or nothing.
  Result<void> finish() const;

 private:
  const nlohmann::json* find(const char* name) const;
  const nlohmann::json* object_;
  std::string where_, complaint_;
};

}  // namespace dubsar
