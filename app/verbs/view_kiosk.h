#pragma once
// dubsar view --kiosk PROFILE.json: the objects of a profile one after the other, until an operator ends it.

#include <filesystem>
#include <functional>
#include <string>

#include "app/cli/verb.h"
#include "app/kiosk/kiosk_profile.h"
#include "app/kiosk/visit.h"
#include "app/viewer/run_view.h"

namespace dubsar::app {

struct KioskSession {
  std::filesystem::path profile;
  /// What a session is asked for, of an object on a display.
  std::function<Result<ViewOptions>(const KioskProfile&, const KioskObject&, const std::string& display)> options;
};

struct KioskOutcome {
  ViewResult last{};
  Visit::Counts counts{};
  int sessions = 0;
  std::size_t triangles = 0;
  std::string display{};
  bool stopped = false;  ///< by a signal; `last` is of the session before, or of none
};

/// Each object is read when it is its turn; those that cannot be read are left out and said. In real time the window
/// comes first, then a coarse surface, then all of it. A display that cannot be had, or whose pixels are not those of
/// the monitor, is replaced by a flat picture, which is said on the screen; a monitor that is not there by another one,
/// until it is. A signal that ends it is no error. Errors: the profile's, of the last object that was left, of the
/// session.
Result<KioskOutcome> run_kiosk(const KioskSession& session, Progress& progress);

/// What a kiosk says that was ended from outside.
VerbResult describe_stopped(const KioskOutcome& done);

/// The tour that a tablet has by itself, as a file to be changed.
Result<VerbResult> write_tour(const std::filesystem::path& path, const TriMesh& mesh, const ViewOptions& view);

}  // namespace dubsar::app
