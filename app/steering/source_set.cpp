#include "app/steering/source_set.h"

#include <chrono>

#include "core/base/system/guarded.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kPauseNs = 2'000'000'000;

}  // namespace

bool is_mistake(ErrorKind kind) noexcept {
  return kind == ErrorKind::kUsage || kind == ErrorKind::kConfig || kind == ErrorKind::kNoInput ||
         kind == ErrorKind::kBadData;
}

bool is_touch_panel(const SourceRow& row) { return row.spec == "touch" || row.spec.starts_with("touch:"); }

SourceSet::SourceSet(InputMixer& mixer, const InputConfig& config, MakeInput make)
    : mixer_(mixer), config_(config), make_(std::move(make)) {}

SourceSet::~SourceSet() {
  if (attempt_) attempt_->result.wait();
}

void SourceSet::adopt(std::size_t index, Result<std::unique_ptr<InputSource>> made) {
  Entry& entry = entries_[index];
  if (made && entry.off) return;  // switched off meanwhile
  if (made) {
    entry.source = made->get();
    entry.reason.clear();
    mixer_.add(*std::move(made), static_cast<int>(index));
  } else {
    entry.reason = made.error().message;
  }
}

Result<void> SourceSet::start(const std::vector<std::string>& specs) {
  std::optional<Error> first;
  bool any = false;
  for (const std::string& spec : specs) {
    entries_.push_back({.spec = spec, .reason = {}});
    auto made = make_(spec, config_);
    if (!made && is_mistake(made.error().kind)) return tl::unexpected<Error>(made.error());
    if (!made) {
      log_warning("{}; tried again every {} s", made.error().message, kPauseNs / 1'000'000'000);
      if (!first) first = made.error();
    }
    any = any || made.has_value();
    adopt(entries_.size() - 1, std::move(made));
  }
  if (!any && first) return tl::unexpected<Error>(*first);
  return {};
}

void SourceSet::tick(TimestampNs now) {
  using namespace std::chrono_literals;
  if (attempt_) {
    if (attempt_->result.wait_for(0s) != std::future_status::ready) return;
    const std::size_t index = attempt_->index;
    auto made = attempt_->result.get();
    attempt_.reset();
    const bool found = made.has_value();
    adopt(index, std::move(made));
    if (found) log_info("input {} is here now", entries_[index].spec);
  }
  if (now < next_try_) return;
  for (; next_index_ < entries_.size(); ++next_index_) {
    const Entry& entry = entries_[next_index_];
    if (entry.source != nullptr || entry.off) continue;
    attempt_ =
        Attempt{next_index_++, std::async(std::launch::async, [make = make_, spec = entry.spec, config = config_] {
                  return guarded("input " + spec, [&] { return make(spec, config); });
                })};
    return;
  }
  next_index_ = 0;
  next_try_ = now + kPauseNs;
}

bool SourceSet::toggle(std::size_t index) {
  if (index >= entries_.size()) return false;
  Entry& entry = entries_[index];
  entry.off = !entry.off;
  if (entry.off && entry.source != nullptr) mixer_.remove(entry.source);
  if (entry.off) entry.source = nullptr;
  entry.reason = entry.off ? "" : "being started";
  if (!entry.off) {
    next_try_ = 0;
    next_index_ = 0;
  }
  return true;
}

std::vector<SourceRow> SourceSet::rows() const {
  std::vector<SourceRow> out;
  for (const Entry& entry : entries_) {
    SourceRow row{entry.spec, SourceHealth::kMissing, entry.reason};
    const auto state = mixer_.state_of(entry.source);
    if (entry.off) {
      row.health = SourceHealth::kOff;
    } else if (state) {
      row.health = state->freshness == Freshness::kLost ? SourceHealth::kLost : SourceHealth::kPresent;
      row.reason = state->note;
      if (row.reason.empty() && row.health == SourceHealth::kLost)
        row.reason = "silent; it is used again when it comes back";
    }
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace dubsar::app
