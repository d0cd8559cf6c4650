#pragma once
// The rules of the contact that can be switched off one by one, to see what each is worth: ./do bench ablation.

#include <cstddef>
#include <cstdint>

#include "core/base/text/enum_names.h"

namespace dubsar {

enum class ContactRule : std::uint8_t {
  kDents,       ///< a dent must prove itself (dents.h)
  kLikelihood,  ///< films are likelier than chance (interface_shape.h)
  kRim,         ///< dips beside free surface count less (interface_shape.h)
  kSettle,      ///< where dips say little the contact becomes smooth (film_refine.h)
  kRounding,    ///< tips of dents are followed farther (film_refine.h)
  kHollow,      ///< out of the hollow of what is bent (film_refine.h)
  kLooks,       ///< patches are moved to their ground more than once (recentre.h)
};

inline constexpr EnumName<ContactRule> kContactRules[] = {
    {ContactRule::kDents, "dents"},   {ContactRule::kLikelihood, "likelihood"}, {ContactRule::kRim, "rim"},
    {ContactRule::kSettle, "settle"}, {ContactRule::kRounding, "rounding"},     {ContactRule::kHollow, "hollow"},
    {ContactRule::kLooks, "looks"},
};
static_assert(names_all(kContactRules, static_cast<std::size_t>(ContactRule::kLooks) + 1));

/// All of them but those that were switched off.
class ContactRules {
 public:
  constexpr ContactRules without(ContactRule rule) const noexcept {
    ContactRules fewer = *this;
    fewer.off_ |= bit(rule);
    return fewer;
  }
  constexpr bool has(ContactRule rule) const noexcept { return (off_ & bit(rule)) == 0; }

 private:
  static constexpr std::uint32_t bit(ContactRule rule) noexcept { return std::uint32_t{1} << static_cast<int>(rule); }
  std::uint32_t off_ = 0;
};

}  // namespace dubsar
