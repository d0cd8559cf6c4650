#pragma once
// The view that people have before their eyes, for simulated ones who look at it.

#include <mutex>

#include "input/navigation/view_state.h"

namespace dubsar {

/// Any thread.
class SeenView {
 public:
  void show(const ViewState& view) {
    const std::lock_guard lock(mutex_);
    view_ = view;
  }
  ViewState look() const {
    const std::lock_guard lock(mutex_);
    return view_;
  }

 private:
  mutable std::mutex mutex_;
  ViewState view_{};  // guarded by mutex_
};

}  // namespace dubsar
