#pragma once
// From sides of the clay near the contact to labels of all grid points.

#include <vector>

#include "core/contact/band.h"
#include "core/extract/labelled/envelope_bits.h"

namespace dubsar {

/// Clay of the band has its side; clay that hangs together beyond it that of most of the band beside it, and the
/// tablet's where it touches none: nobody asks. Islands of few nodes in clay of the other get its label. Cost: a pass
/// over the bits and 10 ns a node. `unasked`, if given, gets the points of what touches none.
EnvelopeBits label_clay(const BitVolume& inside, const ContactBand& band, const std::vector<ClaySide>& side,
                        BitVolume* unasked = nullptr);

}  // namespace dubsar
