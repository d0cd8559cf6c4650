#pragma once
// One table of names per enum, read by the command line, the report and the log: a value that is added to the enum and
// to its table is known everywhere.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dubsar {

template <class Enum>
struct EnumName {
  Enum value;
  std::string_view name;
  std::string_view short_name = "";  ///< also understood, where there is one
};

/// Whether a table has the values 0, 1, 2, ... in their order, each once; for a static_assert beside the table, with
/// the number of values that the enum has.
template <class Enum, std::size_t kCount>
constexpr bool names_all(const EnumName<Enum> (&table)[kCount], std::size_t count) {
  for (std::size_t i = 0; i < kCount; ++i)
    if (static_cast<std::size_t>(table[i].value) != i || table[i].name.empty()) return false;
  return kCount == count;
}

template <class Enum, std::size_t kCount>
constexpr std::string_view name_in(const EnumName<Enum> (&table)[kCount], Enum value) {
  const auto at = static_cast<std::size_t>(value);
  return at < kCount ? table[at].name : std::string_view("unknown");
}

/// What the command line offers: short names where there are any, else names.
template <class Enum, std::size_t kCount>
std::vector<std::pair<std::string, Enum>> choices_of(const EnumName<Enum> (&table)[kCount]) {
  std::vector<std::pair<std::string, Enum>> choices;
  for (const EnumName<Enum>& entry : table)
    choices.emplace_back(entry.short_name.empty() ? entry.name : entry.short_name, entry.value);
  return choices;
}

}  // namespace dubsar
