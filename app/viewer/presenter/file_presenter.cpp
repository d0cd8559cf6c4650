#include "app/viewer/presenter/presenter.h"
#include "display/render/context/context_egl.h"

namespace dubsar::app {

Result<std::unique_ptr<FilePresenter>> FilePresenter::create() {
  DUBSAR_ASSIGN(auto context, EglContext::create());
  return std::unique_ptr<FilePresenter>(new FilePresenter(std::move(context)));
}

Result<void> FilePresenter::fit(const SinkTraits& traits) {
  DUBSAR_ASSIGN(surface_, OffscreenSurface::create(traits.output));
  fields_ = traits.fields;
  return {};
}

}  // namespace dubsar::app
