#include "core/pipeline/holder_stage.h"

#include "core/base/system/log.h"
#include "core/filter/holder_removal.h"

namespace dubsar {

Result<void> take_holder_off(ImportedGrid& imported, const Budget& budget, StageRun run) {
  run.clock.start("holder", "voxel");
  GridStore& half = imported.grid.grid;
  const Dims dims = half.dims();
  DUBSAR_ASSIGN(const std::optional<FoundHolder> found,
                find_holder(half, {.voxels_a_step = 2.0, .left_out = imported.estimate.left_out}, run.progress));
  run.clock.finish(dims.count());
  if (!found) return {};
  imported.facts.holder = found->holder;
  const std::string text = describe(found->holder, imported.scan->frame().input_voxel);
  if (!found->holder.counts_as_air()) {
    imported.facts.warnings.push_back(text);
    log_warning("{}", text);
    return {};
  }
  log_info("{}", text);
  DUBSAR_ASSIGN(HolderMask mask, make_holder_mask(half, *found, run.progress));
  mask.left_out = imported.estimate.left_out;
  const bool is_half = imported.cleaned_is_half();
  imported.holderless =
      std::make_unique<HolderlessSource>(imported.cleaned(), std::move(mask), is_half ? kHolderCell / 2 : kHolderCell);
  half.release();
  DUBSAR_ASSIGN(imported.grid, read_grid(*imported.holderless, !is_half, place_for(dims, budget), budget, run));
  return measure_blur(imported, run);
}

}  // namespace dubsar
