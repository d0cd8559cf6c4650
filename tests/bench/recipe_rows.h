#pragma once
// Phantoms of the recipe without a scanner (blur, noise, rings, cupping), with one artefact more at a time.

#include <string>
#include <vector>

#include "tests/bench/contact_rows.h"

namespace dubsar {

/// Rows of one tablet: "recipe" (17 dB, 1 % rings, 5 % cupping), one artefact each ("cupping .15", "streaks .06",
/// "rings .05", "blur .9", "14 dB", "holder .3", "holder .7"), and "hard": all of them, a quarter glued, streaks a
/// third as strong (lines a tenth of clay deep) or as strong.
std::vector<ContactRow> recipe_rows(const Dims& dims, std::uint64_t seed);

/// Processes `seeds` tablets of each row without options and prints a table of docs/scans.md: mean and half of the
/// range. `only`: names of rows with commas, empty: all.
void print_recipe_rows(const Dims& dims, std::uint64_t seed, int seeds, const std::string& only);

}  // namespace dubsar
