#pragma once
// Finding a panel's lens figures by eye: numbered views in a window on the panel, arrows change the figures.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/command_table.h"
#include "display/sinks/catalog/sink_catalog.h"

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
  /// Keys left, right: centre; up, down: pitch; page_up, page_down: slope; "s" saves for the user; "0" goes back to
  /// what was there. They are good as long as this.
  std::vector<Command> commands();
  std::string text() const;  ///< the figures, as `dubsar displays --adjust` reads them
  bool saved() const noexcept { return saved_; }
  const std::filesystem::path& file() const noexcept { return file_; }  ///< of the last saving

 private:
  struct Figures {
    double pitch = 0.0, slope = 0.0, center = 0.0;
  };
  LensTuner() = default;
  Result<void> use();
  Command step(std::string name, std::string key, std::function<void(Figures&)> change);
  Command save();

  std::shared_ptr<SinkCatalog> catalog_;
  std::filesystem::path folder_, file_;
  PanelProfile panel_;
  Figures first_, now_;
  bool saved_ = false;
};

}  // namespace dubsar::app
