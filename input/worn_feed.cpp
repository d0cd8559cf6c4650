#include "input/worn_feed.h"

#include <utility>

namespace dubsar {

void WornFeed::put(const WornSample& sample) {
  const std::lock_guard lock(mutex_);
  sample_ = sample;
  reason_.clear();
}

void WornFeed::absent(std::string reason) {
  const std::lock_guard lock(mutex_);
  reason_ = std::move(reason);
}

WornSample WornFeed::newest() const {
  const std::lock_guard lock(mutex_);
  return sample_;
}

std::string WornFeed::reason() const {
  const std::lock_guard lock(mutex_);
  return reason_;
}

}  // namespace dubsar
