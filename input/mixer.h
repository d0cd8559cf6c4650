#pragma once
// Several sources as one: the newest of each, hands and heads of the first source that sees any.

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "input/input_source.h"

namespace dubsar {

struct SourceState {
  std::string name;
  Freshness freshness = Freshness::kLost;
  TimestampNs newest = 0;  ///< device time of the newest measurement
  std::string note;        ///< InputSource::note()
};

/// Any thread: what it calls of the sources is called by one at a time.
class InputMixer {
 public:
  /// Adds a started source. Lower ranks, and earlier ones of the same rank, have priority for hands, heads and
  /// SpaceMouse; events of all are merged in time.
  void add(std::unique_ptr<InputSource> source, int rank = 0);
  /// Takes this source out and ends it; false when it is not there. Nobody who polls waits for its end.
  bool remove(const InputSource* source);

  /// Polls all sources. A lost source contributes nothing. Hands of two sources are never mixed: the first that has one
  /// tracked wins, and keeps its right for 300 ms after its last hand; of two
  /// touch panels the one that was touched first, until no finger is on it. Bounded: at most 4096 events a call. The
  /// frame stays until the next call.
  const InputFrame& poll(TimestampNs now);

  /// Makes the present heading "straight on" for all sources whose heading drifts.
  void recentre();

  std::vector<SourceState> states() const;
  /// None when the source is not here.
  std::optional<SourceState> state_of(const InputSource* source) const;
  bool empty() const;
  /// True when a source is here that has no end, such as a device.
  bool endless() const;
  /// True when there is a source with an end and all of those have reached it.
  bool finished() const;

 private:
  struct Entry {
    std::unique_ptr<InputSource> source;
    InputFrame frame;
    Freshness freshness = Freshness::kLost;
    int rank = 0;
  };
  static SourceState describe(const Entry& entry);
  struct Owner {
    const InputSource* source = nullptr;
    TimestampNs until = 0;
  };
  mutable std::mutex mutex_;  // for all below
  std::vector<Entry> sources_;
  Owner hands_, heads_;
  const InputSource* touching_ = nullptr;  // whose glass has fingers on it
  InputFrame merged_;
};

}  // namespace dubsar
