#pragma once
// Gives edges back what the low-pass before 2:1 resampling took (paper section 3.1), once denoising has made room for
// it.

#include <memory>

#include "core/volume/brick_mask.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// The source plus `amount` times its difference from its own Gauss 3x3x3: one step of Van Cittert deconvolution at
/// amount 1. Planar edges keep their place; valleys and ridges, which a low-pass rounds off, come back: on phantoms the
/// wedges of the tablet keep 0.90 instead of 0.86 of their depth, and the distance of the surface from the truth falls
/// from 0.116 to 0.104 voxel RMS. Noise grows by up to (1 + amount).
///
/// `window`: of the Gauss, 3, 5 or 7 voxels. Borrows `source`, which must outlive it, and the mask of `wanted`, as
/// make_denoised() does (denoise.h). Memory: a few slices. Deterministic for any slab height and thread count.
std::unique_ptr<SlabSource> make_sharpened(SlabSource& source, float amount, const Wanted& wanted = {}, int window = 3);

/// How much, and against a Gauss of how many voxels.
struct Sharpening {
  float amount = 0.0f;
  int window = 3;
};

/// What a surface needs whose edges have the variance `blur` (voxels squared, edge_spread.h), behind filters that leave
/// `snr_db`: waves of 6 voxels, which carry wedges of 5 to 7 voxels, get the contrast back that the blur took. Against
/// a Gauss of 7 voxels: it raises such waves by as much as one of 3 voxels with an amount four times as large, and the
/// noise from voxel to voxel only by (1 + amount) times.
///
/// By the noise of the surface, not of voxels: a wedge is some 25 voxels of surface, with six independent errors
/// (filtered noise hangs together over two voxels each way), so that its mean has 8 dB less noise. All of it where that
/// leaves 30 dB, that is from 22 dB of the voxels on, nothing below 24 dB (16 of the voxels), where sharpened noise
/// makes pores and crumbs; in between in proportion.
Sharpening sharpening_for(double blur, double snr_db);

}  // namespace dubsar
