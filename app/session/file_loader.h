#pragma once
// The surfaces of a session that are files: which are open, which is shown, and the one that is being read, in a thread
// of its own, so that the window lives while it is.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/background_job.h"
#include "app/session/file_session.h"
#include "app/session/session_work.h"
#include "core/base/progress.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// A file that was read, and the work on it.
struct OpenedSurface {
  TriMesh mesh;
  SessionWork work;                      ///< its document has the mesh's parts
  std::unique_ptr<FileSession> session;  ///< where the work is kept; null: it is not
  std::string title;
};

/// Told a coarse surface of a file that takes a while, before that itself is read. Returns when somebody has seen it.
using TellCoarse = std::function<void(TriMesh)>;

/// Any thread; the errors of reading.
using ReadSurface = std::function<Result<OpenedSurface>(const std::filesystem::path&, Progress&, const TellCoarse&)>;

/// One thread: that of the session.
class FileLoader {
 public:
  /// `recent` is the list of recent files (app/document/recent_files.h); empty: none is kept.
  FileLoader(ReadSurface read, std::filesystem::path recent);
  ~FileLoader();  ///< stops what is being read, and waits for it: two seconds at most
  FileLoader(const FileLoader&) = delete;
  FileLoader& operator=(const FileLoader&) = delete;

  /// Puts these files beside those that are open, and the first is the next to be read. What was being read before is
  /// left. kNoInput: one of them is not there; kUsage: a folder, or no surface by its name.
  Result<void> open(const std::vector<std::filesystem::path>& files);
  /// These are open, and the first of them is shown.
  void has(const std::vector<std::filesystem::path>& files);
  /// The next (1) or previous (-1) of the open files is the next to be read. kUsage: there is no other.
  Result<void> step(int by);
  /// When nothing is shown and nothing is being read: the first of the open files is the next to be. False: there is
  /// none.
  bool go_on();
  /// What is to be read is read from now on; until then a window has the machine for itself. Again: nothing.
  void start();
  /// Leaves what is being read. False: nothing is.
  bool stop();
  /// The file that was read, or why it cannot be, once. A file that can be is shown from now on.
  std::optional<Result<OpenedSurface>> take();
  /// A coarse surface of the file that is being read, once.
  std::optional<TriMesh> take_coarse();
  /// What take_coarse() gave is on the screen: the rest is read now, and not while the first picture is drawn.
  void coarse_was_shown();
  /// Returns when take() has something, or nothing is being read.
  void wait();

  const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  std::optional<std::size_t> shown() const noexcept { return shown_; }  ///< of files()
  bool busy() const noexcept { return reading_ != nullptr; }
  std::optional<JobState> opening() const;  ///< what is being read
  const std::filesystem::path& recent_list() const noexcept { return recent_; }

 private:
  struct Reading;
  void begin(std::size_t file);

  ReadSurface read_;
  std::filesystem::path recent_;
  std::vector<std::filesystem::path> files_;
  std::optional<std::size_t> shown_;
  std::shared_ptr<Reading> reading_;
  BackgroundJob job_;  ///< that reads it; goes first
};

}  // namespace dubsar::app
