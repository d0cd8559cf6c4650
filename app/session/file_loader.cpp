#include "app/session/file_loader.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <utility>

#include "app/document/file_kinds.h"
#include "app/document/recent_files.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// Stages of reading, with their shares of the time as they were on a tablet of 1.4 million vertices.
std::vector<PlannedStage> reading_plan() {
  return {{"decode signs", 2.0}, {"decode offsets", 3.0}, {"fill holes", 1.0}, {"open", 3.0}};
}
std::vector<PlannedStage> ply_plan() { return {{"read ply vertex", 2.0}, {"read ply face", 3.0}, {"open", 2.0}}; }

}  // namespace

/// One file that is read: what its thread and the window's share.
struct FileLoader::Reading {
  Reading(fs::path path, std::size_t at) : index(at), file(std::move(path)) {}

  /// Its thread. For as long as the first picture may take, that has the processor for itself.
  void show_first(TriMesh mesh) {
    constexpr std::chrono::seconds kLongest(3);
    std::unique_lock lock(mutex);
    if (seen) return;
    coarse = std::move(mesh);
    changed.wait_for(lock, kLongest, [this] { return seen; });
  }
  /// Waits no longer for the coarse surface to be seen.
  void go_on() {
    const std::scoped_lock lock(mutex);
    seen = true;
    changed.notify_all();
  }
  std::optional<TriMesh> take_coarse() {
    const std::scoped_lock lock(mutex);
    return std::exchange(coarse, std::nullopt);
  }

  const std::size_t index;
  const fs::path file;
  bool started = false;                  // the window's thread
  std::optional<OpenedSurface> surface;  // of the reading thread, until the job is done
  std::mutex mutex;                      // for those below
  std::condition_variable changed;
  std::optional<TriMesh> coarse;
  bool seen = false;
};

FileLoader::FileLoader(ReadSurface read, fs::path recent) : read_(std::move(read)), recent_(std::move(recent)) {}

FileLoader::~FileLoader() { stop(); }

void FileLoader::begin(std::size_t file) {
  stop();
  reading_ = std::make_shared<Reading>(files_[file], file);
}

Result<void> FileLoader::open(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) DUBSAR_TRY(check_surface_file(file));
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
  const std::size_t from = reading_ ? reading_->index : shown_.value_or(0);
  begin((from + (by > 0 ? 1 : count - 1)) % count);
  return {};
}

bool FileLoader::go_on() {
  if (shown_ || reading_ || files_.empty()) return false;
  begin(0);
  return true;
}

bool FileLoader::stop() {
  if (!reading_) return false;
  reading_->go_on();
  job_.stop();
  reading_.reset();
  return true;
}

std::optional<Result<OpenedSurface>> FileLoader::take() {
  const auto done = job_.take();
  if (!done) return std::nullopt;
  const std::shared_ptr<Reading> read = std::exchange(reading_, nullptr);
  Result<OpenedSurface> out = done->map([&] { return std::move(*read->surface); });
  if (out) {
    shown_ = read->index;
    if (const auto kept = remember_recent(recent_, read->file); !kept) log_warning("{}", kept.error().message);
  } else if (shown_ != read->index) {  // it is not open
    files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(read->index));
    if (shown_ && *shown_ > read->index) --*shown_;
  }
  return out;
}

std::optional<TriMesh> FileLoader::take_coarse() { return reading_ ? reading_->take_coarse() : std::nullopt; }

void FileLoader::coarse_was_shown() {
  if (reading_) reading_->go_on();
}

void FileLoader::start() {
  if (!reading_ || reading_->started) return;
  reading_->started = true;
  const auto work = [reading = reading_, read = read_](Progress& progress) -> Result<void> {
    DUBSAR_ASSIGN(reading->surface,
                  read(reading->file, progress, [&](TriMesh mesh) { reading->show_first(std::move(mesh)); }));
    return {};
  };
  job_.begin(reading_->file.filename().string(), work,
             lower_suffix(reading_->file) == ".ply" ? ply_plan() : reading_plan());
}

void FileLoader::wait() {
  if (!reading_) return;
  reading_->go_on();  // nobody looks meanwhile
  start();
  job_.wait();
}

std::optional<JobState> FileLoader::opening() const {
  if (!reading_) return std::nullopt;
  return reading_->started ? job_.state() : JobState{reading_->file.filename().string()};
}

}  // namespace dubsar::app
