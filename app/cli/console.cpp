#include "app/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/base/json_text.h"

namespace dubsar::app {
namespace {

std::atomic<Progress*> g_signal_target{nullptr};

void on_signal(int) {
  Progress* const target = g_signal_target.load();
  if (target == nullptr || target->cancelled()) ::_exit(exit_code(ErrorKind::kCancelled));
  target->cancel();
}

double now_s() { return 1e-9 * static_cast<double>(SteadyClock().now()); }

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// 12 345 678 items/s as "12.3 M".
std::string with_prefix(double value) {
  for (const auto& [scale, prefix] : {std::pair{1e9, " G"}, std::pair{1e6, " M"}, std::pair{1e3, " k"}})
    if (value >= scale) return fmt::format("{:.1f}{}", value / scale, prefix);
  return fmt::format("{:.0f} ", value);
}

void put(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

bool stderr_is_terminal() {
  const char* const terminal = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && (terminal == nullptr || std::strcmp(terminal, "dumb") != 0);
}

bool stderr_has_colour() {
  const char* const no_colour = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (no_colour == nullptr || *no_colour == '\0');
}

ConsoleProgress::ConsoleProgress(const ConsoleOptions& options) : style_(options.progress), quiet_(options.quiet) {
  if (style_ == ProgressStyle::kAuto && quiet_) style_ = ProgressStyle::kNone;
  if (style_ == ProgressStyle::kAuto && stderr_is_terminal()) style_ = ProgressStyle::kBar;
  if (style_ == ProgressStyle::kBar || style_ == ProgressStyle::kJson)
    refresher_ = std::jthread([this](std::stop_token stop) { refresh_loop(stop); });
}

ConsoleProgress::~ConsoleProgress() {
  if (refresher_.joinable()) {
    refresher_.request_stop();
    changed_.notify_all();
    refresher_.join();
  }
  const std::lock_guard lock(mutex_);
  finish_stage();
}

void ConsoleProgress::on_begin(std::string_view stage, std::int64_t total, std::string_view unit) {
  const std::lock_guard lock(mutex_);
  finish_stage();
  stage_ = stage;
  unit_ = unit;
  total_ = total;
  started_s_ = now_s();
  shown_done_.store(0, std::memory_order_relaxed);
  active_ = true;
  if (style_ == ProgressStyle::kBar || style_ == ProgressStyle::kJson) print_line(false);
}

void ConsoleProgress::on_advance(std::int64_t done) { shown_done_.store(done, std::memory_order_relaxed); }

void ConsoleProgress::on_end() {
  const std::lock_guard lock(mutex_);
  finish_stage();
}

void ConsoleProgress::finish_stage() {
  if (!active_) return;
  if (style_ != ProgressStyle::kNone) print_line(true);
  active_ = false;
}

void ConsoleProgress::refresh_loop(std::stop_token stop) {
  using namespace std::chrono_literals;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait_for(lock, stop, style_ == ProgressStyle::kBar ? 100ms : 400ms, [] { return false; });
    if (active_ && !stop.stop_requested()) print_line(false);
  }
}

void ConsoleProgress::print_line(bool finished) {
  const double elapsed = now_s() - started_s_;
  std::int64_t done = shown_done_.load(std::memory_order_relaxed);
  if (finished && !cancelled() && total_ > 0) done = total_;
  if (total_ > 0) done = std::min(done, total_);
  const double percent = total_ > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(total_) : 0.0;
  const double rate = elapsed > 0.0 ? static_cast<double>(done) / elapsed : 0.0;
  const double eta = finished ? 0.0 : estimate_remaining_s(done, total_, elapsed);
  if (style_ == ProgressStyle::kJson) {
    nlohmann::json line{{"stage", stage_},      {"done", done},         {"total", total_},
                        {"unit", unit_},        {"percent", percent},   {"rate_per_s", rate},
                        {"elapsed_s", elapsed}, {"finished", finished}, {"rss_mib", peak_rss_mib()}};
    line["eta_s"] = eta >= 0.0 ? nlohmann::json(eta) : nlohmann::json(nullptr);
    put(dump_json(line) + "\n");
    return;
  }
  if (style_ == ProgressStyle::kBar) {
    constexpr int kWidth = 24;
    const int filled = total_ > 0 ? static_cast<int>(kWidth * percent / 100.0) : 0;
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kWidth - filled), '.');
    const std::string tail = finished     ? fmt::format("{:.2f} s", elapsed)
                             : eta >= 0.0 ? "ETA " + duration(eta)
                                          : "ETA -:--";
    put(fmt::format("\r\x1b[K{:<12} [{}] {:3.0f} %  {}{}/s  {}", stage_, bar, percent, with_prefix(rate), unit_, tail));
    line_open_ = !finished;
    if (finished) put("\n");
    return;
  }
  if (finished) put(fmt::format("{:<12} {:8.2f} s  {}{}/s\n", stage_, elapsed, with_prefix(rate), unit_));
}

void install_log(const ConsoleOptions& options) {
  const bool colour = stderr_has_colour();
  set_log_handler([options, colour](LogLevel level, std::string_view message) {
    if (level == LogLevel::kDebug && !options.verbose) return;
    if (level != LogLevel::kError && options.quiet) return;
    const std::string_view prefix = level == LogLevel::kError     ? "error: "
                                    : level == LogLevel::kWarning ? "warning: "
                                                                  : "";
    const std::string_view on = !colour                       ? ""
                                : level == LogLevel::kError   ? "\x1b[31m"
                                : level == LogLevel::kWarning ? "\x1b[33m"
                                                              : "";
    const std::string_view start = stderr_is_terminal() ? "\r\x1b[K" : "";
    put(fmt::format("{}{}{}{}{}\n", start, on, prefix, on.empty() ? "" : "\x1b[0m", message));
  });
}

void cancel_on_signals(Progress& progress) {
  g_signal_target.store(&progress);
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error of write(2), not a death
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace dubsar::app
