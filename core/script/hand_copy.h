#pragma once
// The hand copy: each side of a tablet as a line drawing of its wedges, at true scale.

#include <array>
#include <string>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"
#include "core/script/copy_sheet.h"
#include "core/script/find_wedges.h"
#include "core/script/marks/script_marks.h"

namespace dubsar {

enum class CopyStyle : std::uint8_t {
  kOutlined,  ///< heads as triangles, flanks run together into the tail
  kFilled,    ///< the same, black
  kWeighted,  ///< outlined, the deeper the heavier
};

inline constexpr EnumName<CopyStyle> kCopyStyles[] = {
    {CopyStyle::kOutlined, "outlined"}, {CopyStyle::kFilled, "filled"}, {CopyStyle::kWeighted, "weighted"}};
static_assert(names_all(kCopyStyles, static_cast<std::size_t>(CopyStyle::kWeighted) + 1));

struct HandCopyOptions {
  CopyStyle style = CopyStyle::kOutlined;
  std::string title, made_by = "dubsar";
  bool whole_plate = true;             ///< all sides on one sheet, edges beside the sides that they join
  TextSide side = TextSide::kObverse;  ///< else this one alone
  bool line_numbers = true;
  ScriptMarks marks;  ///< each kind in a layer of its own on each side
};

/// Directions of a side as it is drawn: seen along its normal, edges with the obverse's right or up.
struct CopyView {
  glm::dvec3 right, up, front;
};
CopyView copy_view(const TabletFrame& frame, TextSide side);

/// Orthographic: a mm on the clay that faces the reader is a mm on paper. Outlines are the tablet's silhouettes;
/// inferred surface is hatched crosswise, with a legend; kinds of
/// wedges, rulings, cracks, seals, what is inferred, outlines and numbers have a layer each on each side; a ruler of
/// whole cm below. kBadData: no triangles.
Result<CopySheet> hand_copy(const TriMesh& mesh, const WedgesFound& found, const HandCopyOptions& options);

}  // namespace dubsar
