#pragma once
// The only way from the keys into a kiosk: an operator types a number, or brings a file.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/system/clock.h"

namespace dubsar::app {

enum class OperatorWish {
  kClose,
  kNextObject,
  kNextLanguage,
  kReset,
  kRetryDevices,
  kNextDisplay,
  kBrighter,
  kDarker,
  kEnd
};

struct OperatorRow {
  char key;
  std::string_view words;
  OperatorWish wish;
};

/// Swallows every key. Digits make a number that the return key ends and that is forgotten after 10 s; five wrong ones
/// in a row are followed by 30 s in which none is looked at. The open menu closes by itself after 60 s. One thread.
class OperatorMenu {
 public:
  /// `pin` of digits; empty: keys never open it.
  explicit OperatorMenu(std::string pin) : pin_(std::move(pin)) {}

  /// A key that went down, by its name: "1", "enter", "escape". What is wished when the menu is open.
  std::optional<OperatorWish> key(std::string_view key, TimestampNs now);
  /// The operator's file came or went.
  void file_present(bool present, TimestampNs now);
  /// Closes what stood open for too long.
  void tick(TimestampNs now);

  bool open() const noexcept { return open_; }
  bool locked(TimestampNs now) const noexcept { return now < locked_until_; }
  static const std::vector<OperatorRow>& rows();

 private:
  void enter(TimestampNs now);
  std::string pin_, typed_;
  TimestampNs typed_at_ = 0, opened_at_ = 0, locked_until_ = 0;
  int wrong_ = 0;
  bool open_ = false, file_ = false;
};

}  // namespace dubsar::app
