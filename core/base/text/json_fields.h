#pragma once
// Reads fields of a JSON object with their ranges; each thing wrong becomes one sentence.

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  /// A list of at most so many things; empty where it is missing.
  const nlohmann::json& list(const char* name, std::size_t most);

  /// A list of at most so many texts, none of which is empty; missing: none.
  std::vector<std::string> texts(const char* name, std::size_t most);
  /// Refuses what is no object, and members of it that are none of these.
  void only(std::span<const std::string_view> known);
  void only(std::initializer_list<std::string_view> known) { only(std::span(known.begin(), known.size())); }

  bool has(const char* name) const { return object_->is_object() && object_->contains(name); }
  const std::string& where() const noexcept { return where_; }
  /// `member` is what it is about, or "member/inner" of what it holds.
  void complain(std::string sentence, std::string_view member = {});
  struct Complaint {
    std::string member, sentence;
  };
  const std::vector<Complaint>& complaints() const noexcept { return complaints_; }
  /// The first complaint, or nothing.
  Result<void> finish(ErrorKind kind = ErrorKind::kConfig) const;

 private:
  const nlohmann::json* find(const char* name) const;
  const nlohmann::json* object_;
  std::string where_;
  std::vector<Complaint> complaints_;
};

/// JsonFields::only() alone, with errors of this kind.
Result<void> check_members(const nlohmann::json& object, std::span<const std::string_view> known, std::string where,
                           ErrorKind kind = ErrorKind::kBadData);

/// kBadData: `name` is no list of `least` to `most` things in this object.
Result<void> check_list(const nlohmann::json& object, const char* name, std::size_t least, std::size_t most,
                        const std::string& where);

/// The things of the list `name`, each as read(thing, "where: name[2]") returns it, a Result<T>. The list may be
/// missing where `least` is 0. Errors of check_list() and of read().
template <class T, class Read>
Result<std::vector<T>> read_list(const nlohmann::json& object, const char* name, std::size_t least, std::size_t most,
                                 const std::string& where, const Read& read) {
  std::vector<T> out;
  if (least == 0 && !object.contains(name)) return out;
  DUBSAR_TRY(check_list(object, name, least, most, where));
  for (const nlohmann::json& thing : object.at(name)) {
    DUBSAR_ASSIGN(T one, read(thing, fmt::format("{}: {}[{}]", where, name, out.size())));
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace dubsar
