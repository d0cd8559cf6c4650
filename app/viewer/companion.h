#pragma once
// The surface that stands beside that of a session, as its document says: read in a thread of its own, shown with the
// same looks by the same light, and turned as that one is, each from its own way up.

#include <memory>
#include <optional>
#include <string>

#include "app/session/file_loader.h"
#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"
#include "display/render/images/label_font.h"

namespace dubsar::app {

/// A surface that was read, with the box that it fills, mm of its scan.
struct CompanionSurface {
  std::shared_ptr<const OpenedSurface> opened;
  Box box{};
  explicit CompanionSurface(OpenedSurface read);
};

/// What stands below the two: their names without folders and endings.
struct CompanionNames {
  LabelFont* font = nullptr;  ///< outlives the pictures; null: nothing
  std::string own;
  double letters = 1.0;  ///< as of marks
};

/// What was done to an object that stood at `home` done to one that stands at `next`; the light stays the next one's.
ViewState carried_over(const ViewState& home, const ViewState& seen, const ViewState& next);

/// The file that a document names, or one of that name beside its own surface where that is not there.
std::filesystem::path companion_file(const Document& document);

/// Puts it beside what `document` shows. Parts of the same names look as the document's; its cuts and marks are its own
/// surface's alone.
void put_beside(Shown& shown, const Document& document, const CompanionSurface& companion, const StageOptions& stage,
                const CompanionNames& names);

class CompanionTool final : public Tool {
 public:
  /// `read` may be none: nothing can stand beside. `scene` and `font` outlive it.
  CompanionTool(ToolScene& scene, ReadSurface read, LabelFont& font);
  void update(TimestampNs now) override;
  void contribute(Shown& shown) override;
  std::optional<JobState> opening() const { return loader_.opening(); }
  /// Why what the document names cannot be shown.
  const std::optional<Error>& failed() const noexcept { return failed_; }
  void set_own_name(std::string name) { own_name_ = std::move(name); }

 private:
  void look_for(const Companion& wanted);
  void fail_with(const Error& why);

  ToolScene& scene_;
  LabelFont& font_;
  FileLoader loader_;
  bool reads_;
  Companion asked_;  ///< its file; what was taken away may come back by undo
  std::optional<CompanionSurface> surface_;
  Companion shown_;  ///< what `surface_` is
  std::optional<Error> failed_;
  std::string own_name_;
};

}  // namespace dubsar::app
