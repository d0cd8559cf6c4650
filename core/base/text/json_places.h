#pragma once
// Where things stand in a JSON text, so that what is wrong with them can be told by line and column.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

class JsonPlaces {
 public:
  /// `text` is one that parse_json() has read; of anything else some places are missing.
  explicit JsonPlaces(std::string_view text);

  /// The byte where the name of a member, or a thing of a list, begins: "/objects/0/title/de"; that of what holds it
  /// where it is missing.
  std::size_t at(std::string_view pointer) const;
  /// Behind what stands there; at() where that is a list or an object.
  std::size_t end(std::string_view pointer) const;
  /// Members whose name was there already; the last one counts.
  const std::vector<std::string>& repeated() const noexcept { return repeated_; }

 private:
  void walk(const std::string& pointer, int level);
  void skip();
  std::string name();
  std::string_view text_;
  std::size_t at_ = 0;
  struct Place {
    std::size_t begin = 0, end = 0;
  };
  const Place& place(std::string_view pointer) const;
  std::map<std::string, Place, std::less<>> places_;
  std::vector<std::string> repeated_;
};

}  // namespace dubsar
