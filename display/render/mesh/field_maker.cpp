#include "display/render/mesh/field_maker.h"

#include <new>
#include <utility>

namespace dubsar {

FieldMaker::FieldMaker(const TriMesh& mesh, const FieldNeeds& needs)
    : needs_(needs), thread_([this, &mesh] {
        Result<SurfaceFields> made = fail(ErrorKind::kTryAgain, "no memory to measure the surface");
        try {
          made = measure_fields(mesh, needs_, count_);
        } catch (const std::bad_alloc&) {  // said above
        }
        const std::scoped_lock lock(mutex_);
        made_ = std::move(made);
      }) {}

FieldMaker::~FieldMaker() { count_.cancel(); }

std::optional<Result<SurfaceFields>> FieldMaker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

}  // namespace dubsar
