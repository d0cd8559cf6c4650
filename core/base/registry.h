#pragma once
// Back ends of an interface: one ordered constexpr table per interface, no self-registration.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

template <class Interface, class Config>
struct Backend {
  std::string_view name;
  std::string_view summary;
  bool auto_select;  ///< false: null, image, simulated, replayed back ends, which are named or never taken
  Result<std::unique_ptr<Interface>> (*create)(const Config&);
};

/// Finds a back end by name. `what` is the interface in words, for the error text, which lists all names.
template <class Interface, class Config>
Result<const Backend<Interface, Config>*> find_backend(std::span<const Backend<Interface, Config>> table,
                                                       std::string_view name, std::string_view what) {
  std::string names;
  for (const auto& backend : table) {
    if (backend.name == name) return &backend;
    names += names.empty() ? "" : ", ";
    names += backend.name;
  }
  return fail(ErrorKind::kUsage, "no {} is called \"{}\", expected one of: {}", what, name, names);
}

}  // namespace dubsar
