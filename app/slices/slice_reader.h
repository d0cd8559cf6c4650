#pragma once
// Pictures of slices, made in a thread of their own: whoever shows them never waits for a file.

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/slices/scan_link.h"
#include "app/slices/slice_frame.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// A piece of the surface's outline in a picture, in its pixels.
struct OutlinePiece {
  glm::vec2 a{0.0f}, b{0.0f};
  PartitionId partition = 0;
  bool inferred = false;  ///< the scan shows no surface there
  friend bool operator==(const OutlinePiece&, const OutlinePiece&) = default;
};

/// One state of a picture; it is not changed any more.
struct SlicePicture {
  SliceFrame frame;
  PlaneImage image;  ///< without values where there is no scan; NaN where it is not read yet
  std::vector<OutlinePiece> outline;
  bool exact = false, done = false;  ///< done: nothing more will be read of it
};
/// The outline of a surface in a picture, what of it is seen.
std::vector<OutlinePiece> outline_in(const TriMesh& mesh, const SliceFrame& frame);
using SharedSlice = std::shared_ptr<const SlicePicture>;

/// All members from one thread.
class SliceReader {
 public:
  using OpenScan = std::function<Result<OpenedScan>()>;
  /// `mesh` outlives it. `open` is called once, in the thread; null: there is no scan, only outlines.
  SliceReader(const TriMesh& mesh, OpenScan open);
  ~SliceReader();
  SliceReader(const SliceReader&) = delete;
  SliceReader& operator=(const SliceReader&) = delete;

  /// The newest question about a slice is answered: coarse first, after some 40 ms, then all four in turn exact.
  void ask(std::size_t which, const SliceFrame& frame);
  /// What is there of a slice; null: nothing yet. It may be of an earlier question.
  SharedSlice picture(std::size_t which) const;
  /// Why there is no scan, or what is to be known of it; empty: nothing.
  std::string note() const;
  bool has_scan() const;
  /// Returns when all that was asked for is exact.
  void wait() const;

 private:
  struct Slot {
    std::optional<SliceFrame> asked;
    std::uint64_t question = 0;
    bool coarse = true, exact = true;  ///< nothing is left to do
    SharedSlice picture;
  };
  enum class Left { kNothing, kCoarse, kExact };
  void run(const std::stop_token& stop, const OpenScan& open);
  void answer(std::size_t which, bool exact, const std::stop_token& stop);
  void publish(std::size_t which, std::uint64_t question, SlicePicture picture, bool done);
  std::pair<Left, std::size_t> next() const;

  const TriMesh& mesh_;
  std::unique_ptr<PlaneSampler> sampler_;  // of the thread
  glm::dvec3 voxel_mm_{1.0};
  mutable std::mutex mutex_;  // for all below
  mutable std::condition_variable_any changed_;
  std::array<Slot, kSlices> slots_;
  std::string note_;
  bool opened_ = false, has_scan_ = false, over_ = false;  // over: a mistake has ended the thread, note_ says which
  std::jthread thread_;                                    // ends first
};

}  // namespace dubsar::app
