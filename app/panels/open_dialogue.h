#pragma once
// Opening files in the window: what was opened last, folders with the surfaces in them, and how far a file is that is
// being read.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/key_table.h"
#include "app/document/folder_listing.h"
#include "app/document/job_state.h"

namespace dubsar::app {

struct RecentFile {
  std::string path;
  bool there = true;
  friend bool operator==(const RecentFile&, const RecentFile&) = default;
};

/// What panels know of files.
struct FilesState {
  bool has_surface = true;           ///< something is shown
  bool beside = false;               ///< what is chosen stands beside it
  std::vector<std::string> names{};  ///< of the open files, without their folders
  std::size_t shown = 0;             ///< of them
  std::optional<JobState> opening{};
  std::vector<RecentFile> recent{};        ///< while the dialogue is open
  std::optional<FolderListing> listing{};  ///< the same
  friend bool operator==(const FilesState&, const FilesState&) = default;
};

/// A line of the dialogue.
struct DialogueRow {
  std::string words, detail;  ///< detail: of a recent file its folder, of others their size
  std::string command;        ///< empty: it is not there any more, or a heading
  bool heading = false, folder = false;
  friend bool operator==(const DialogueRow&, const DialogueRow&) = default;
};

/// What the dialogue lists when this was typed: recent files, then the folder; those that have it in their names. What
/// can be opened as it was typed (a path) stands first.
std::vector<DialogueRow> dialogue_rows(const FilesState& files, std::string_view typed);

/// "reading tablet.exa: 43 %, about 5 s to go"; without the figures while nobody knows them.
std::string opening_words(const JobState& opening);

/// The file that is shown and the one that is being read: "tablet.exa", "tablet.exa, reading next.exa: 43 %"; empty
/// where there is neither.
std::string title_words(const std::string& shown, const std::optional<JobState>& opening);

/// Draws the dialogue into the current frame while `open`, and appends what was chosen.
void draw_open_dialogue(bool open, const FilesState& files, float width, float height,
                        std::vector<std::string>& commands);

/// How far the file is that is being read, and a way to stop it. It stands at the lower edge, so that the surface stays
/// free.
void draw_opening(const FilesState& files, float width, float height, std::vector<std::string>& commands);

}  // namespace dubsar::app
