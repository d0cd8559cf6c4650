#include "app/session/file_loader.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "app/cli/overall_progress.h"
#include "app/document/file_kinds.h"
#include "app/document/recent_files.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/clock.h"
#include "core/base/system/guarded.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// Stages of reading, with their shares of the time as they were on a tablet of 1.4 million vertices.
std::vector<PlannedStage> reading_plan() {
  return {{"decode signs", 2.0}, {"decode offsets", 3.0}, {"fill holes", 1.0}, {"open", 3.0}};
}
std::vector<PlannedStage> ply_plan() { return {{"read ply vertex", 2.0}, {"read ply face", 3.0}, {"open", 2.0}}; }

double seconds_now() { return 1e-9 * static_cast<double>(SteadyClock().now()); }

Result<void> check_file(const fs::path& file) {
  DUBSAR_TRY(check_surface_file(file));
  if (!names_a_surface(file))
    return fail(ErrorKind::kUsage, "{} is no surface by its name, expected {}", file.string(), kSurfaceSuffixes);
  return {};
}

}  // namespace

/// One file that is read in a thread.
class FileLoader::Reading final : public Progress {
 public:
  Reading(fs::path file, std::size_t index)
      : index_(index), file_(std::move(file)), whole_(lower_suffix(file_) == ".ply" ? ply_plan() : reading_plan()) {}
  void start(const ReadSurface& read) {
    if (!thread_.joinable())
      thread_ = std::jthread([this, read] {
        auto made = guarded(file_.string(),
                            [&] { return read(file_, *this, [this](TriMesh mesh) { show_first(std::move(mesh)); }); });
        const std::scoped_lock lock(mutex_);
        made_ = std::move(made);
        done_ = true;
        changed_.notify_all();
      });
  }
  ~Reading() override { leave(); }
  void leave() {
    cancel();
    go_on();
  }
  /// Waits no longer for the coarse surface to be seen.
  void go_on() {
    const std::scoped_lock lock(mutex_);
    seen_ = true;
    changed_.notify_all();
  }

  std::size_t index() const noexcept { return index_; }
  const fs::path& file() const noexcept { return file_; }
  bool started() const { return thread_.joinable(); }
  bool done() const {
    const std::scoped_lock lock(mutex_);
    return done_;
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return done_; });
  }
  Result<OpenedSurface> take() {
    const std::scoped_lock lock(mutex_);
    return std::move(*made_);
  }
  std::optional<TriMesh> take_coarse() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(coarse_, std::nullopt);
  }
  Opening state() const {
    const std::scoped_lock lock(mutex_);
    return {file_.filename().string(), whole_.fraction(), whole_.remaining_s(seconds_now())};
  }

 protected:
  void on_begin(std::string_view stage, std::int64_t total, std::string_view) override {
    const std::scoped_lock lock(mutex_);
    total_ = total;
    whole_.begin(stage, seconds_now());
  }
  void on_advance(std::int64_t done) override {
    const std::unique_lock lock(mutex_, std::try_to_lock);  // who works waits for nobody
    if (lock && total_ > 0) whole_.advance(static_cast<double>(done) / static_cast<double>(total_), seconds_now());
  }
  void on_end() override {
    const std::scoped_lock lock(mutex_);
    whole_.end(seconds_now());
  }

 private:
  /// For as long as the first picture may take, it has the processor for itself.
  void show_first(TriMesh mesh) {
    constexpr std::chrono::seconds kLongest(3);
    std::unique_lock lock(mutex_);
    if (seen_) return;
    coarse_ = std::move(mesh);
    changed_.wait_for(lock, kLongest, [this] { return seen_; });
  }

  const std::size_t index_;
  const fs::path file_;
  mutable std::mutex mutex_;  // for those below
  std::condition_variable changed_;
  OverallProgress whole_;
  std::int64_t total_ = 0;
  std::optional<TriMesh> coarse_;
  std::optional<Result<OpenedSurface>> made_;
  bool done_ = false, seen_ = false;
  std::jthread thread_;  // goes first
};

FileLoader::FileLoader(ReadSurface read, fs::path recent) : read_(std::move(read)), recent_(std::move(recent)) {}

FileLoader::~FileLoader() {
  for (const auto& each : left_) each->leave();
}

void FileLoader::begin(std::size_t file) {
  stop();
  reading_ = std::make_unique<Reading>(files_[file], file);
}

Result<void> FileLoader::open(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) DUBSAR_TRY(check_file(file));
  std::optional<std::size_t> first;
  for (const fs::path& file : files) {
    std::error_code error;
    const fs::path whole = fs::absolute(file, error).lexically_normal();
    auto at = std::find(files_.begin(), files_.end(), whole);
    if (at == files_.end()) at = files_.insert(files_.end(), whole);
    if (!first) first = static_cast<std::size_t>(at - files_.begin());
  }
  if (first) begin(*first);
  return {};
}

void FileLoader::has(const std::vector<fs::path>& files) {
  std::error_code error;
  for (const fs::path& file : files) files_.push_back(fs::absolute(file, error).lexically_normal());
  shown_ = 0;
}

Result<void> FileLoader::step(int by) {
  const std::size_t count = files_.size();
  if (count < 2) return fail(ErrorKind::kUsage, "one file is open, there is no other to go to");
  const std::size_t from = reading_ ? reading_->index() : shown_.value_or(0);
  begin((from + (by > 0 ? 1 : count - 1)) % count);
  return {};
}

bool FileLoader::go_on() {
  if (shown_ || reading_ || files_.empty()) return false;
  begin(0);
  return true;
}

bool FileLoader::stop() {
  std::erase_if(left_, [](const auto& each) { return each->done(); });
  if (!reading_) return false;
  reading_->leave();
  if (reading_->started()) left_.push_back(std::move(reading_));
  reading_.reset();
  return true;
}

std::optional<Result<OpenedSurface>> FileLoader::take() {
  if (!reading_ || !reading_->done()) return std::nullopt;
  const std::unique_ptr<Reading> read = std::move(reading_);
  Result<OpenedSurface> out = read->take();
  if (out) {
    shown_ = read->index();
    if (const auto kept = remember_recent(recent_, read->file()); !kept) log_warning("{}", kept.error().message);
  } else if (shown_ != read->index()) {  // it is not open
    files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(read->index()));
    if (shown_ && *shown_ > read->index()) --*shown_;
  }
  return out;
}

std::optional<TriMesh> FileLoader::take_coarse() { return reading_ ? reading_->take_coarse() : std::nullopt; }

void FileLoader::coarse_was_shown() {
  if (reading_) reading_->go_on();
}

void FileLoader::start() {
  if (reading_) reading_->start(read_);
}

void FileLoader::wait() {
  if (!reading_) return;
  reading_->go_on();  // nobody looks meanwhile
  start();
  reading_->wait();
}

std::optional<Opening> FileLoader::opening() const {
  return reading_ ? std::optional(reading_->state()) : std::nullopt;
}

}  // namespace dubsar::app
