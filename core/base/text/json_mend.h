#pragma once
// All slips of a text that should be JSON: each is mended as its writer meant it, and reading goes on.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text/json_fault.h"

namespace dubsar {

struct MendedJson {
  std::vector<JsonFault> faults{};  ///< in the order in which they are met, at bytes of the text that was given
  std::string text{};               ///< with what could be mended
  bool whole = false;               ///< nothing is left to be mended
  /// The byte of the given text that stands at a byte of `text`, or before it.
  std::size_t given_at(std::size_t at) const;
  /// Whether something was mended in these bytes of `text`, so that what stands there is not what was written.
  bool mended_in(std::size_t begin, std::size_t end) const;

 private:
  friend MendedJson mend_json(std::string_view text);
  std::vector<std::size_t> from_{};  // of each byte
  std::size_t given_size_ = 0;
  std::vector<std::pair<std::size_t, std::size_t>> touched_{};
};

/// At most 40 slips; ends at the first one that nobody can guess, such as UTF-16.
MendedJson mend_json(std::string_view text);

}  // namespace dubsar
