#pragma once
// What was made of the surfaces of a session: kept in files while they are shown, when they are left, and at the end.

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "app/commands/editor.h"
#include "app/session/file_session.h"

namespace dubsar::app {

/// One thread: that of the session.
class KeptWork {
 public:
  using MakeEditor = std::function<std::unique_ptr<Editor>(History history, Document opened)>;
  /// `say` has a line over the picture.
  explicit KeptWork(std::function<void(std::string)> say) : say_(std::move(say)) {}
  /// Another file is shown from now on: as it was left in this window, or as it was found. Its editor.
  std::unique_ptr<Editor> begin(Document found, std::unique_ptr<FileSession> session, const MakeEditor& make);
  /// The present one goes; its undo stays, in the next sessions, too, and what could not be written.
  void leave(Editor& editor);
  /// Writes what is due. True: what another window kept of the same surface is in the document now, too.
  bool keep(Editor& editor, TimestampNs now);
  /// What the next sessions find, of all files; null: none is shown.
  Result<void> leave_all(Editor* editor);
  /// As leave_all(); where that fails it is said, and true the second time.
  bool may_end(Editor* editor);
  /// Somebody does something else than to end.
  void goes_on() noexcept { asked_ = false; }
  /// Says what is to be known of files, or else what there is to say: `first`, or what was found beside it.
  void say_what_was_found(const Editor& editor, std::string first);
  /// What is to be known of files goes to the log.
  std::vector<std::string> log_told();
  void forget_trouble() { untold_.clear(); }

 private:
  struct Left {
    std::unique_ptr<FileSession> session;  ///< null: its work could be written
    Document opened;
    History history;
  };
  Result<void> leave_session(Editor& editor);
  void tell(std::string otherwise);

  std::function<void(std::string)> say_;
  std::unique_ptr<FileSession> session_;  ///< keeps the work; null: nothing is kept
  std::map<std::string, Left> left_;      ///< those that were shown before, by their path and content
  std::string untold_;                    ///< what could not be kept, as it was told last
  bool asked_ = false;                    ///< whether to end without having kept it
};

}  // namespace dubsar::app
