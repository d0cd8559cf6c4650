#pragma once
// Measures figures of a surface in a thread of its own, while pictures of it go on.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "display/render/mesh/surface_field.h"

namespace dubsar {

class FieldMaker {
 public:
  /// `mesh` outlives it. `other`: what a difference is from.
  FieldMaker(const TriMesh& mesh, const FieldNeeds& needs, std::shared_ptr<const TriMesh> other = {});
  ~FieldMaker();  ///< stops the work and waits for its end, some milliseconds
  FieldMaker(const FieldMaker&) = delete;
  FieldMaker& operator=(const FieldMaker&) = delete;

  const FieldNeeds& needs() const noexcept { return needs_; }
  const std::shared_ptr<const TriMesh>& other() const noexcept { return other_; }
  /// How much is done, 0..1.
  double share() const noexcept { return share_.load(std::memory_order_relaxed); }
  /// What became of it, once; nothing while it works. kTryAgain without memory.
  std::optional<Result<SurfaceFields>> take();

 private:
  class Count final : public Progress {
   public:
    explicit Count(std::atomic<double>& share) : share_(&share) {}

   protected:
    void on_begin(std::string_view, std::int64_t total, std::string_view) override { total_ = total; }
    void on_advance(std::int64_t done) override {
      share_->store(total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 0.0,
                    std::memory_order_relaxed);
    }

   private:
    std::atomic<double>* share_;
    std::atomic<std::int64_t> total_{0};
  };

  FieldNeeds needs_;
  std::shared_ptr<const TriMesh> other_;
  std::atomic<double> share_{0.0};
  Count count_{share_};
  std::mutex mutex_;
  std::optional<Result<SurfaceFields>> made_;
  std::jthread thread_;  // goes first
};

}  // namespace dubsar
