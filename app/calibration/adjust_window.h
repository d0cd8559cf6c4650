#pragma once
// Finding a panel's lens figures by eye: numbered views in a window on the panel, arrows change the figures.

#include <filesystem>
#include <memory>
#include <string>

#include "app/viewer/live.h"
#include "display/sinks/sink_catalog.h"

namespace dubsar::app {

/// The figures of a panel while somebody changes them with keys. They count in `catalog` from each key on, and for good
/// once they are saved.
class LensTuner {
 public:
  /// `folder` is where the user's panels are. Figures of `calibration` count before the profile's. Errors of
  /// choose_panel; kConfig for a panel without lens figures.
  static Result<LensTuner> create(std::shared_ptr<SinkCatalog> catalog, const std::filesystem::path& folder,
                                  const std::string& panel, const std::filesystem::path& calibration = {});

  /// What shows the panel with the figures of now.
  SinkSpec display() const;
  /// left, right: centre; up, down: pitch; page_up, page_down: slope; "s" saves for the user; "0" goes back to what was
  /// there.
  KeyAnswer key(const std::string& name);
  std::string text() const;  ///< the figures, as `dubsar displays --adjust` reads them
  bool saved() const noexcept { return saved_; }
  const std::filesystem::path& file() const noexcept { return file_; }  ///< of the last saving

 private:
  struct Figures {
    double pitch = 0.0, slope = 0.0, center = 0.0;
  };
  LensTuner() = default;
  Result<void> use();

  std::shared_ptr<SinkCatalog> catalog_;
  std::filesystem::path folder_, file_;
  PanelProfile panel_;
  Figures first_, now_;
  bool saved_ = false;
};

}  // namespace dubsar::app
