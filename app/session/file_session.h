#pragma once
// The work on one surface while a window has it: found when the surface is opened, kept while somebody works and when
// they leave, together with what other windows keep of the same surface meanwhile.

#include <array>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/document/other_work.h"
#include "app/session/work_places.h"
#include "core/base/files/kept_file.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

/// Looking at a surface that nobody worked on changes nothing on the disk; work that was found elsewhere, or in pieces,
/// is brought to both places of the surface. A file that cannot be read (damaged, or of a newer version) or belongs to
/// another surface gets another name (KeptFile::set_aside()) when its place is needed, and is found again by this one.
/// One thread.
class FileSession {
 public:
  /// Looks for the work. `state_folder` may be empty. Milliseconds, and files of at most some hundred kB each.
  FileSession(SourceFile source, const std::filesystem::path& state_folder);

  const SourceFile& source() const noexcept { return source_; }
  /// Where the steps of the work are kept (kept_history.h); empty: nowhere.
  std::filesystem::path history_file() const;
  /// There is work on the disk.
  bool has_work() const noexcept { return any_; }
  /// Of this surface, whatever its name was; none: nobody worked on it.
  const std::optional<Document>& found() const noexcept { return found_; }
  /// Work of surfaces that this one took the place of, with notes, measures or keyframes that found() lacks.
  const std::vector<OtherWork>& others() const noexcept { return others_; }
  /// What a person should know of files, a sentence each; each is told once.
  std::vector<std::string> take_told();

  /// What the window begins with; that alone is no work.
  void begin(const Document& first);

  /// Every five seconds writes what differs from what was kept, and else looks for what another window kept, in a
  /// thread of its own: a disk takes longer than a picture may. Gives the document with what another window kept
  /// meanwhile, which takes the place of `document`; none: go on. What went wrong is told by a later call, and tried
  /// again.
  Result<std::optional<Document>> keep(TimestampNs now, const Document& document);
  /// The same at once; the document as it was kept. When it fails it can be tried again.
  Result<Document> leave(const Document& document);
  /// What another window kept meanwhile, as keep() gives it.
  std::optional<Document> look(const Document& document);
  /// Waits for what keep() writes.
  void wait() const;
  /// Whether all of it is on the disk, in each place that may be written; having looked at a surface is no work.
  bool has_kept(const Document& document) const;

 private:
  using Places = std::array<KeptFile, 2>;
  struct Told {
    std::vector<std::string> all;
    std::size_t said = 0;
  };
  /// What became of an attempt to write.
  struct Outcome {
    Result<void> done;
    std::optional<Work> theirs{};  ///< somebody kept it, and nothing was written over it
    std::vector<std::string> told{};
    bool behind = false;  ///< one of the places could not be written
    bool looked = false;  ///< nothing was to be written
  };
  static Outcome write(Places& places, const Work& work);
  static Outcome look_around(Places& places, const Work& mine);
  static Result<std::optional<Work>> meet(Places& places, KeptFile& file, const Work& mine,
                                          std::vector<std::string>& told);
  Work next(const Document& document);
  std::optional<Document> take(Outcome outcome, const Document& document);

  SourceFile source_;
  Places places_;  ///< not while writing_
  std::optional<Document> found_;
  std::vector<OtherWork> others_;
  Told told_;
  std::string name_;      ///< of this session, among saves
  Saves saves_;           ///< that this document followed from
  Work kept_;             ///< as it is on the disk, or as it began
  bool any_ = false;      ///< there is work on the disk
  bool behind_ = false;   ///< one of the places has not all of it
  bool looking_ = false;  ///< nothing is being written, if anything is going on
  TimestampNs next_ = 0;
  Work writing_work_;
  std::optional<Error> failed_;
  std::future<Outcome> writing_;  ///< goes first
};

}  // namespace dubsar::app
