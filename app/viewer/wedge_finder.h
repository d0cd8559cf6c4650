#pragma once
// Wedges of a session's surface, looked for beside the window.

#include <memory>
#include <optional>
#include <string>

#include "app/commands/editor.h"
#include "app/session/background_job.h"
#include "core/script/find_wedges.h"

namespace dubsar::app {

/// One thread: that of the session.
class WedgeFinder {
 public:
  /// Begins to look for the wedges of a part: of the tablet where none is named, if that is shown, else of the first
  /// one that is; of everything where there are no parts. kUsage: no part of this name.
  Result<void> begin(const TriMesh& mesh, const Document& document, const std::string& part);
  bool stop() { return job_.stop(); }
  std::optional<JobState> state() const { return job_.state(); }
  void wait() { job_.wait(); }
  /// Once they are there: a step of the document, and what is to be said; or why there are none.
  std::optional<std::string> ended(Editor& editor);

 private:
  struct Sought {
    std::string part;
    WedgesFound found;
  };
  BackgroundJob job_;
  std::shared_ptr<Sought> sought_;
};

}  // namespace dubsar::app
