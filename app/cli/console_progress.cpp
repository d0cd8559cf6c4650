#include "app/cli/console_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "core/base/system/clock.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {

constexpr double kQuietLinesEveryS = 10.0;
constexpr int kWidestBar = 30, kNarrowestBar = 5, kPlainColumns = 80;

double now_s() { return 1e-9 * static_cast<double>(SteadyClock().now()); }

std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(seconds);
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// 12 345 678 items/s as "12.3 M".
std::string with_prefix(double value) {
  for (const auto& [scale, prefix] : {std::pair{1e9, " G"}, std::pair{1e6, " M"}, std::pair{1e3, " k"}})
    if (value >= scale) return fmt::format("{:.1f}{}", value / scale, prefix);
  return fmt::format("{:.0f} ", value);
}

}  // namespace

std::string stage_in_words(std::string_view stage) {
  struct Words {
    std::string_view stage, words;
  };
  constexpr std::array<Words, 27> kWords{{{"estimate_raw", "judging noise"},
                                          {"estimate", "judging noise"},
                                          {"import", "reading"},
                                          {"denoise", "denoising"},
                                          {"extract", "finding surface"},
                                          {"mesh", "meshing"},
                                          {"smooth", "smoothing"},
                                          {"settle", "settling"},
                                          {"segment", "separating"},
                                          {"fill holes", "closing holes"},
                                          {"ambient occlusion", "ambient light"},
                                          {"encode signs", "writing"},
                                          {"encode offsets", "writing"},
                                          {"write exa", "writing"},
                                          {"decode signs", "reading"},
                                          {"decode offsets", "reading"},
                                          {"render", "drawing"},
                                          {"animate", "drawing"},
                                          {"look", "looking"},
                                          {"video", "making video"},
                                          {"phantom", "making a scan"},
                                          {"project", "X-raying"},
                                          {"expose", "reading panel"},
                                          {"reconstruct", "reconstructing"},
                                          {"truth", "writing truth"},
                                          {"simplify", "simplifying"}}};
  for (const Words& known : kWords)
    if (known.stage == stage) return std::string(known.words);
  return std::string(stage);
}

std::string progress_line(const ProgressLine& line, int columns) {
  const int room = std::max(20, columns - 1);  // the last column would wrap on some terminals
  std::string tail = line.fraction
                         ? fmt::format(" {:3.0f} %  {}", std::floor(100.0 * *line.fraction), clock_text(line.elapsed_s))
                         : "  " + clock_text(line.elapsed_s);
  if (line.remaining_s) tail += ", " + rough_duration(*line.remaining_s) + " left";
  const int name = std::clamp(columns / 4, 10, 18);
  std::string out = line.doing.substr(0, static_cast<std::size_t>(name));
  const int bar = std::min(kWidestBar, room - name - 3 - static_cast<int>(tail.size()));
  if (line.fraction && bar >= kNarrowestBar) {
    const int filled = static_cast<int>(bar * std::clamp(*line.fraction, 0.0, 1.0));
    out.resize(static_cast<std::size_t>(name), ' ');
    out += " [" + std::string(static_cast<std::size_t>(filled), '#') +
           std::string(static_cast<std::size_t>(bar - filled), '.') + "]";
  }
  out += tail;
  return out.substr(0, static_cast<std::size_t>(room));
}

ConsoleProgress::ConsoleProgress(const ConsoleOptions& options, std::vector<PlannedStage> plan)
    : style_(options.progress),
      quiet_(options.quiet),
      verbose_(options.verbose),
      overall_(std::move(plan)),
      started_s_(now_s()),
      said_s_(started_s_) {
  if (style_ == ProgressStyle::kAuto && quiet_) style_ = ProgressStyle::kNone;
  if (style_ == ProgressStyle::kAuto && stderr_is_terminal()) style_ = ProgressStyle::kBar;
  if (style_ != ProgressStyle::kNone)
    refresher_ = std::jthread([this](const std::stop_token& stop) { refresh_loop(stop); });
}

ConsoleProgress::~ConsoleProgress() {
  try {
    close();
  } catch (const std::exception&) {  // a line that stays on the terminal
  }
}

void ConsoleProgress::close() {
  if (refresher_.joinable()) {
    refresher_.request_stop();
    changed_.notify_all();
    refresher_.join();
  }
  const std::lock_guard lock(mutex_);
  finish_stage();
  if (line_open_) put_on_stderr("\r\x1b[K");
  line_open_ = false;
}

void ConsoleProgress::on_begin(std::string_view stage, std::int64_t total, std::string_view unit) {
  const std::lock_guard lock(mutex_);
  finish_stage();
  const double now = now_s();
  stage_ = {std::string(stage), std::string(unit), total, now, true};
  overall_.begin(stage, now);
  done_.store(0, std::memory_order_relaxed);
  if (style_ == ProgressStyle::kBar || style_ == ProgressStyle::kJson) print(false);
}

void ConsoleProgress::on_advance(std::int64_t done) { done_.store(done, std::memory_order_relaxed); }

void ConsoleProgress::on_end() {
  const std::lock_guard lock(mutex_);
  finish_stage();
}

void ConsoleProgress::finish_stage() {
  if (!stage_.active) return;
  print(true);
  stage_.active = false;
}

void ConsoleProgress::refresh_loop(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait_for(lock, stop, style_ == ProgressStyle::kBar ? 200ms : 400ms, [] { return false; });
    if (stage_.active && !stop.stop_requested()) print(false);
  }
}

ProgressLine ConsoleProgress::line(double now) {
  const std::int64_t done = done_.load(std::memory_order_relaxed);
  const double part =
      stage_.total > 0 ? std::min(1.0, static_cast<double>(done) / static_cast<double>(stage_.total)) : 0.0;
  if (!overall_.planned())
    return {stage_in_words(stage_.name), stage_.total > 0 ? std::optional<double>(part) : std::nullopt,
            now - started_s_, std::nullopt};
  overall_.advance(part, now);
  return {stage_in_words(stage_.name), overall_.fraction(), now - started_s_, overall_.remaining_s(now)};
}

void ConsoleProgress::print_json(bool finished, double now) {
  const double elapsed = now - stage_.started_s;
  std::int64_t done = done_.load(std::memory_order_relaxed);
  if (finished && !cancelled() && stage_.total > 0) done = stage_.total;
  if (stage_.total > 0) done = std::min(done, stage_.total);
  const double eta = finished ? 0.0 : estimate_remaining_s(done, stage_.total, elapsed);
  const ProgressLine all = line(now);
  nlohmann::json object{
      {"stage", stage_.name},
      {"done", done},
      {"total", stage_.total},
      {"unit", stage_.unit},
      {"percent", stage_.total > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(stage_.total) : 0.0},
      {"rate_per_s", elapsed > 0.0 ? static_cast<double>(done) / elapsed : 0.0},
      {"elapsed_s", elapsed},
      {"finished", finished},
      {"rss_mib", peak_rss_mib()}};
  object["eta_s"] = eta >= 0.0 ? nlohmann::json(eta) : nlohmann::json(nullptr);
  if (overall_.planned()) {
    object["overall_percent"] = 100.0 * all.fraction.value_or(0.0);
    object["overall_elapsed_s"] = all.elapsed_s;
    object["overall_eta_s"] = all.remaining_s ? nlohmann::json(*all.remaining_s) : nlohmann::json(nullptr);
  }
  put_on_stderr(dump_json(object) + "\n");
}

void ConsoleProgress::print(bool finished) {
  const double now = now_s();
  switch (style_) {
    case ProgressStyle::kNone:
      return;
    case ProgressStyle::kJson:
      return print_json(finished, now);
    case ProgressStyle::kBar:
      put_on_stderr("\r\x1b[K" + progress_line(line(now), stderr_columns()));
      line_open_ = true;
      return;
    case ProgressStyle::kAuto:
      break;
  }
  if (finished && verbose_) {
    const double elapsed = now - stage_.started_s;
    const auto done = static_cast<double>(stage_.total > 0 ? stage_.total : done_.load(std::memory_order_relaxed));
    put_on_stderr(fmt::format("{:<18} {:8.2f} s  {}{}/s\n", stage_.name, elapsed,
                              with_prefix(elapsed > 0 ? done / elapsed : 0.0), stage_.unit));
  } else if (now - said_s_ >= kQuietLinesEveryS) {
    put_on_stderr(progress_line(line(now), kPlainColumns) + "\n");
    said_s_ = now;
  }
}

}  // namespace dubsar::app
