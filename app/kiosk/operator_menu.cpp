#include "app/kiosk/operator_menu.h"

#include <algorithm>

#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kForgets = 10 * kSecondNs, kLocks = 30 * kSecondNs, kCloses = 60 * kSecondNs;
constexpr std::size_t kLongest = 16;
constexpr int kMostWrong = 5;

bool is_digit(std::string_view key) { return key.size() == 1 && key[0] >= '0' && key[0] <= '9'; }

}  // namespace

const std::vector<OperatorRow>& OperatorMenu::rows() {
  static const std::vector<OperatorRow> all{
      {'1', "next object", OperatorWish::kNextObject},
      {'2', "next language", OperatorWish::kNextLanguage},
      {'3', "begin again", OperatorWish::kReset},
      {'4', "look for devices again", OperatorWish::kRetryDevices},
      {'5', "next display", OperatorWish::kNextDisplay},
      {'+', "brighter", OperatorWish::kBrighter},
      {'-', "darker", OperatorWish::kDarker},
      {'9', "end the kiosk", OperatorWish::kEnd},
      {'0', "close this menu", OperatorWish::kClose},
  };
  return all;
}

void OperatorMenu::enter(TimestampNs now) {
  const bool right = !pin_.empty() && typed_ == pin_;
  typed_.clear();
  if (right) {
    open_ = true;
    opened_at_ = now;
    wrong_ = 0;
  } else if (++wrong_ >= kMostWrong) {
    locked_until_ = now + kLocks;
    wrong_ = 0;
  }
}

std::optional<OperatorWish> OperatorMenu::key(std::string_view key, TimestampNs now) {
  tick(now);
  if (open_) {
    opened_at_ = now;
    const auto& all = rows();
    const auto row =
        std::find_if(all.begin(), all.end(), [&](const OperatorRow& r) { return key.size() == 1 && key[0] == r.key; });
    if (row == all.end() && key != "escape") return std::nullopt;
    const OperatorWish wish = row == all.end() ? OperatorWish::kClose : row->wish;
    if (wish == OperatorWish::kClose || wish == OperatorWish::kEnd || wish == OperatorWish::kNextObject) open_ = false;
    return wish;
  }
  if (locked(now)) return std::nullopt;
  if (is_digit(key)) {
    if (typed_.size() < kLongest) typed_ += key;
    typed_at_ = now;
  } else if (key == "enter") {
    if (!typed_.empty()) enter(now);
  } else {
    typed_.clear();
  }
  return std::nullopt;
}

void OperatorMenu::file_present(bool present, TimestampNs now) {
  if (present && !file_) {
    open_ = true;
    opened_at_ = now;
  }
  file_ = present;
}

void OperatorMenu::tick(TimestampNs now) {
  if (open_ && now - opened_at_ >= kCloses) open_ = false;
  if (!typed_.empty() && now - typed_at_ >= kForgets) typed_.clear();
}

}  // namespace dubsar::app
