#pragma once
// Everything that can be done, each once: a name for scripts and mappings, words for people, keys, and what it does.
// The help, the panels, mapping files and scripts read this table and nothing else.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/editor.h"
#include "app/words/text.h"
#include "core/base/result.h"

namespace dubsar::app {

/// A key as key_chord() writes it, and what the command is told when it is pressed.
struct DefaultKey {
  std::string key, argument{};
};

struct Command {
  std::string name;                   ///< "turn_left"
  Text group;                         ///< heading it stands under: "View", "Sides" ...
  std::vector<DefaultKey> keys;       ///< with which it is called unless a mapping says otherwise
  Text argument{};                    ///< what its argument is: "degrees"; none: it takes none
  std::vector<std::string> values{};  ///< arguments worth offering; when `closed`, all there are
  bool closed = false;
  bool optional = false;                         ///< its argument may be left out
  bool repeats = false;                          ///< a key that is held does it again and again
  bool steers = false;                           ///< moves the view, which somebody else may be holding
  std::function<bool(const Editor&)> enabled{};  ///< none: always
  std::function<Result<void>(Editor&, const std::string& argument)> run{};
  Text words{};  ///< "turn to the left"; none: add() finds "command.NAME" of the table of texts
};

/// An argument as people read it: "upper left", "relief". What has no text, a number or a name, is itself.
std::string argument_words(const Command& command, const std::string& argument);

class CommandTable {
 public:
  /// The program's commands; `styles` are the names of the shadings there are.
  static CommandTable standard(const std::vector<std::string>& styles);

  /// Names are told apart by their caller: two of the same are a mistake of ours, as is one without a text.
  void add(Command command);
  std::span<const Command> all() const noexcept { return commands_; }
  /// Null: there is none of this name.
  const Command* find(std::string_view name) const;
  /// Whether "NAME" or "NAME ARGUMENT" can be said. kUsage with what was expected.
  Result<void> check(std::string_view text) const;
  /// Does what the text says, as one step of the history at most. kUsage: as check(), or a command that cannot be done
  /// now; the command's own errors.
  Result<void> run(std::string_view text, Editor& editor) const;

 private:
  std::vector<Command> commands_;
};

/// "side reverse" is "side" and "reverse".
std::pair<std::string_view, std::string> split_command(std::string_view text);

/// Heading of those that concern the window and change no document.
inline constexpr Text kWindowGroup = "group.window";

/// Heading of those that open files.
inline constexpr Text kFileGroup = "group.files";

/// Parts of the table, each in a file of its own.
std::vector<Command> view_commands();                                        ///< turning, zooming, sides, undo and redo
std::vector<Command> look_commands(const std::vector<std::string>& styles);  ///< light, style, parts
std::vector<Command> shade_commands(const std::vector<std::string>& styles);  ///< blends, radiance, colours, legend
std::vector<Command> light_commands();                                        ///< light that goes round
std::vector<Command> back_face_commands();                                    ///< the inner side of surfaces
std::vector<Command> mark_commands();                                         ///< tools, measures, notes
std::vector<Command> text_commands();                                         ///< lines of text, ATF, the record
std::vector<Command> section_commands();                                      ///< cuts and fog
std::vector<Command> slice_commands();                                        ///< slices of the scan
std::vector<Command> export_commands();                                       ///< what is published
std::vector<Command> wedge_commands();                                        ///< wedges of an edition
std::vector<Command> film_commands();
std::vector<Command> file_commands();       ///< opening surfaces
std::vector<Command> companion_commands();  ///< another surface beside this one
std::vector<Command> work_commands();       ///< copies of the work, and work that was found
std::vector<Command> window_commands();     ///< help, displays, sources, the window

/// Takes in a line of text between two places, as one step (text_lines.h), and opens it.
void add_text_line(Editor& editor, const std::vector<SurfacePin>& ends, std::string text);
/// A wedge in a sentence: its number, kind, depth, where it stands and whose it is.
std::string wedge_words(const ScriptWedge& wedge);
/// Says so where a line runs over clay whose surface the scan does not show, and its text tells no damage.
void warn_of_patch(Editor& editor, const Note& line);

}  // namespace dubsar::app
