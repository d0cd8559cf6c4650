#include "core/base/text/json_places.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"

namespace dubsar {

JsonPlaces::JsonPlaces(std::string_view text) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  skip();
  places_[""] = {at_, at_};
  walk("", 0);
}

void JsonPlaces::skip() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

/// A text in quotes at at_, without them; at_ stands behind it then.
std::string JsonPlaces::name() {
  const std::size_t begin = at_++;
  while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
  at_ = std::min(at_ + 1, text_.size());
  const auto read = nlohmann::json::parse(text_.substr(begin, at_ - begin), nullptr, false);
  return read.is_string() ? read.get<std::string>() : std::string();
}

void JsonPlaces::walk(const std::string& pointer, int level) {
  skip();
  if (at_ >= text_.size() || level > kJsonMaxDepth) return;
  const char open = text_[at_];
  if (open == '"') {
    name();
    return;
  }
  if (open != '{' && open != '[') {
    at_ = std::min(text_.find_first_of(" \t\r\n,]}", at_), text_.size());
    return;
  }
  ++at_;
  for (std::size_t i = 0; at_ < text_.size(); ++i) {
    skip();
    if (at_ >= text_.size()) return;
    if (text_[at_] == '}' || text_[at_] == ']') {
      ++at_;
      return;
    }
    const std::size_t begin = at_;
    if (open == '{' && text_[at_] != '"') return;
    const std::string inner = pointer + "/" + (open == '{' ? name() : std::to_string(i));
    if (!places_.insert_or_assign(inner, Place{begin, begin}).second) repeated_.push_back(inner);
    skip();
    if (open == '{' && at_ < text_.size() && text_[at_] == ':') ++at_;
    const bool plain = at_ < text_.size() && text_.find_first_of("{[", at_) != text_.find_first_not_of(" \t\r\n", at_);
    walk(inner, level + 1);
    if (plain) places_[inner].end = at_;
    skip();
    if (at_ < text_.size() && text_[at_] == ',') ++at_;
    if (at_ == begin) return;  // no JSON
  }
}

const JsonPlaces::Place& JsonPlaces::place(std::string_view pointer) const {
  static constexpr Place kNone{};
  for (;;) {
    if (const auto found = places_.find(pointer); found != places_.end()) return found->second;
    if (pointer.empty()) return kNone;
    pointer = pointer.substr(0, pointer.rfind('/'));
  }
}

std::size_t JsonPlaces::at(std::string_view pointer) const { return place(pointer).begin; }
std::size_t JsonPlaces::end(std::string_view pointer) const { return place(pointer).end; }

}  // namespace dubsar
