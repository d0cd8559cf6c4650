#pragma once
// `--do COMMAND` of the verbs that draw: a session without a window is told the window's commands, so that what the
// verbs draw and what a window shows is one thing.

#include <string>
#include <vector>

#include "app/cli/arguments.h"
#include "app/viewer/view_options.h"
#include "core/base/progress.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {

void add_do_option(Arguments& command, std::vector<std::string>& commands);

/// Before any work: kUsage with what was expected where one of them is no command.
Result<void> check_told(const std::vector<std::string>& commands);

/// The commands as steps of a session, all of them at its first picture.
std::vector<TimedCommand> steps_of(const std::vector<std::string>& commands);

/// A screen that is all picture; pixels are square.
Screen screen_of(int width_px, int height_px);

enum class ToldPart { kDocument, kPicture };

struct ToldSession {
  Document document;
  DisplayPicture seen;  ///< what the display shows then, without panels; empty unless it was wanted
};

/// What a session of `mesh` without a window is when it was told `commands` one after the other and has come to rest.
/// `view` says display, pixels, samples and the first look, as for a window; its time, inputs and steps are not looked
/// at. Makes a GL context for the time of the call; main thread. Errors of run_view(), of the command that fails.
Result<ToldSession> tell_session(const TriMesh& mesh, ViewOptions view, const std::vector<std::string>& commands,
                                 ToldPart wanted, Progress& progress);

/// The same for pictures that are made without a stage: the looks of the document that a session has when it was told
/// `commands`. Style, mixture, light, parts, cuts and fog take the place of those of `shading`, which is that of
/// `style`.
Result<void> dress_as_told(const TriMesh& mesh, const std::string& style, const std::vector<std::string>& commands,
                           Shading& shading, Progress& progress);

}  // namespace dubsar::app
