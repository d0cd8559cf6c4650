#include "app/document/history.h"

#include <utility>

namespace dubsar::app {
namespace {
constexpr std::size_t kMostSteps = 1000;
}

void History::change(Document next, std::string words, std::uint64_t merge) {
  if (next == now_) return;
  const bool same_step = merge != 0 && future_.empty() && !past_.empty() && past_.back().merge == merge;
  future_.clear();
  if (!same_step) {
    if (past_.size() == kMostSteps) past_.erase(past_.begin());
    past_.push_back({std::move(now_), std::move(words), merge});
  }
  now_ = std::move(next);
  if (same_step && past_.back().other == now_) past_.pop_back();  // there and back again
}

void History::change_all(Document next, const std::function<Document(const Document&)>& with_it) {
  for (std::vector<Step>* steps : {&past_, &future_})
    for (Step& step : *steps) step.other = with_it(step.other);
  now_ = std::move(next);
}

bool History::undo() {
  if (past_.empty()) return false;
  Step step = std::move(past_.back());
  past_.pop_back();
  std::swap(step.other, now_);
  step.merge = 0;  // what comes next is another step
  future_.push_back(std::move(step));
  return true;
}

bool History::redo() {
  if (future_.empty()) return false;
  Step step = std::move(future_.back());
  future_.pop_back();
  std::swap(step.other, now_);
  past_.push_back(std::move(step));
  return true;
}

}  // namespace dubsar::app
