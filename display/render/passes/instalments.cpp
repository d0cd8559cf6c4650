#include "display/render/passes/instalments.h"

#include <algorithm>

#include "display/render/passes/mesh_pass.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPiece = 8192;  // triangles between two looks at the clock: a millisecond without a GPU
constexpr GLuint64 kLongestWaitNs = 1'000'000'000;

}  // namespace

Instalments& Instalments::operator=(Instalments&& other) noexcept {
  std::swap(done_, other.done_);
  std::swap(at_, other.at_);
  std::swap(end_, other.end_);
  std::swap(paused_, other.paused_);
  std::swap(asked_, other.asked_);
  return *this;
}

Instalments::~Instalments() {
  for (const GLsync fence : asked_)
    if (fence != nullptr) glDeleteSync(fence);
}

void Instalments::begin(TimestampNs end) {
  if (asked_[0] != nullptr) {
    glClientWaitSync(asked_[0], GL_SYNC_FLUSH_COMMANDS_BIT, kLongestWaitNs);
    glDeleteSync(asked_[0]);
  }
  asked_ = {asked_[1], nullptr};
  at_ = 0;
  end_ = end;
  paused_ = false;
}

void Instalments::finish() {
  if (asked_[1] != nullptr) glDeleteSync(asked_[1]);
  asked_[1] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
}

std::int64_t Instalments::pass(std::int64_t count) noexcept {
  const std::int64_t passed = std::clamp<std::int64_t>(done_ - at_, 0, count);
  at_ += passed;
  return passed;
}

void Instalments::did(std::int64_t count) {
  at_ += count;
  done_ = at_;
  paused_ = SteadyClock().now() >= end_;
}

void Instalments::draw(const TriangleRanges& ranges, GLsizei instances) {
  for (auto [first, count] : ranges) {
    const std::int64_t passed = pass(count);
    first += passed;
    count -= passed;
    while (count > 0) {
      if (paused_) return;
      const std::int64_t piece = std::min(count, kPiece);
      draw_ranges({{first, piece}}, instances);
      did(piece);
      first += piece;
      count -= piece;
    }
  }
}

}  // namespace dubsar
