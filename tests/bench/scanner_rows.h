#pragma once
// Phantoms that a simulated scanner scanned: one artefact at a time, all of them mildly to strongly, in half a turn of
// parallel rays and in the full turn of a cone.

#include <string>
#include <vector>

#include "tests/bench/contact_rows.h"

namespace dubsar {

/// Rows of one tablet: "clean", one artefact each, "good" to "strong" by half a turn, then those of a cone.
std::vector<ContactRow> scanner_rows(const Dims& dims, std::uint64_t seed);

/// Processes `seeds` tablets of each row without options and prints a table of docs/scans.md: mean and half of the
/// range. `only`: names of rows with commas, empty: all.
void print_scanner_rows(const Dims& dims, std::uint64_t seed, int seeds, const std::string& only);

}  // namespace dubsar
