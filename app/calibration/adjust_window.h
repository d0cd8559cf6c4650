#pragma once
// Finding a panel's lens figures by eye: numbered views in a window on the panel, arrows change the figures.

#include <filesystem>
#include <string>

#include "app/viewer/live.h"
#include "display/panels/panel_profile.h"

namespace dubsar::app {

/// The figures of a panel while somebody changes them with keys.
class LensTuner {
 public:
  /// Works on copies of the profiles of `folder` in `scratch`, an empty folder. Errors of load_profiles, find_profile;
  /// kConfig for a panel without lens figures; figures of `calibration` count before the profile's.
  static Result<LensTuner> create(const std::filesystem::path& folder, const std::filesystem::path& scratch,
                                  const std::string& panel, const std::filesystem::path& calibration = {});

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

  std::filesystem::path folder_, scratch_, file_;
  std::string panel_;
  Figures first_, now_;
  bool saved_ = false;
};

}  // namespace dubsar::app
