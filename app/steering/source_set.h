#pragma once
// The sources of a live session: started where they can be, tried again where they cannot, switched on and
// off by hand.

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/source_row.h"
#include "input/input_source.h"
#include "input/mixer.h"

namespace dubsar::app {

/// Whether it is that of a touch panel.
bool is_touch_panel(const SourceRow& row);

using MakeInput = std::function<Result<std::unique_ptr<InputSource>>(std::string_view spec, const InputConfig&)>;

/// One thread, except that missing sources are tried again in another one: opening a device may take its
/// time.
class SourceSet {
 public:
  /// `mixer` outlives the set.
  SourceSet(InputMixer& mixer, const InputConfig& config, MakeInput make = make_input);
  ~SourceSet();
  SourceSet(const SourceSet&) = delete;
  SourceSet& operator=(const SourceSet&) = delete;

  /// Earlier ones have priority. Mistakes in the words are errors (kUsage, kConfig, kNoInput, kBadData); a
  /// source whose device cannot be had is kept as missing, and an error only when no source can be had at
  /// all.
  Result<void> start(const std::vector<std::string>& specs);
  /// Takes in what was found, and begins to look again where it is time. Cheap.
  void tick(TimestampNs now);
  /// Switches source `index` on or off; false when there is none.
  bool toggle(std::size_t index);
  void retry_now() noexcept { next_try_ = 0; }

  std::vector<SourceRow> rows() const;

 private:
  struct Entry {
    std::string spec, reason;
    const InputSource* source = nullptr;  // in the mixer
    bool off = false;
  };
  struct Attempt {
    std::size_t index = 0;
    std::future<Result<std::unique_ptr<InputSource>>> result;
  };
  void adopt(std::size_t index, Result<std::unique_ptr<InputSource>> made);

  InputMixer& mixer_;
  InputConfig config_;
  MakeInput make_;
  std::vector<Entry> entries_;
  std::optional<Attempt> attempt_;
  TimestampNs next_try_ = 0;
  std::size_t next_index_ = 0;
};

/// A mistake in what was asked for, rather than something that is not there now.
bool is_mistake(ErrorKind kind) noexcept;

}  // namespace dubsar::app
