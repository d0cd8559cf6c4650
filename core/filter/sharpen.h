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
/// Borrows `source`, which must outlive it, and the mask of `wanted`, as make_denoised() does (denoise.h). Memory: a
/// few slices. Deterministic for any slab height and thread count.
std::unique_ptr<SlabSource> make_sharpened(SlabSource& source, float amount, const Wanted& wanted = {});

/// The same against a Gauss of 7 voxels, which gives waves of wedges (6 voxels) four times as much for the same noise
/// from voxel to voxel. Surfaces move, but none is made: a value does not go to the other side of `level` where none of
/// its 26 neighbours was there, so that noise opens no pore and a film no shred.
std::unique_ptr<SlabSource> make_widely_sharpened(SlabSource& source, float amount, float level,
                                                  const Wanted& wanted = {});

/// How much of the wide one a scan needs beside `amount` of the narrow one, so that waves of 6 voxels get their
/// contrast back: 0 where edges of the variance `blur` (voxels squared, edge_spread.h) leave them as much as good scans
/// do.
///
/// By the noise of the surface: a wedge is some 25 voxels of it with six independent errors (filtered noise hangs
/// together over two voxels each way), whose mean has 8 dB less noise than a voxel. All where that leaves 30 dB
/// (`snr_db` 22), nothing below 24 dB.
float wide_sharpening(double blur, double snr_db, float amount);

}  // namespace dubsar
