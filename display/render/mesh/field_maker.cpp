#include "display/render/mesh/field_maker.h"

#include <utility>

#include "core/base/system/guarded.h"

namespace dubsar {

FieldMaker::FieldMaker(const TriMesh& mesh, const FieldNeeds& needs, std::shared_ptr<const TriMesh> other)
    : needs_(needs), other_(std::move(other)), thread_([this, &mesh] {
        auto made =
            guarded("the surface's measures", [&] { return measure_fields(mesh, needs_, count_, other_.get()); });
        const std::scoped_lock lock(mutex_);
        made_ = std::move(made);
      }) {}

FieldMaker::~FieldMaker() { count_.cancel(); }

std::optional<Result<SurfaceFields>> FieldMaker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

}  // namespace dubsar
