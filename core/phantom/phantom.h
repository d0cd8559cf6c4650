#pragma once
// An enclosed Old Assyrian tablet as an implicit model, evaluated at any point: what a scan of it should give, and the
// truth a result is judged by.

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/phantom/options.h"
#include "core/phantom/phantom_parts.h"
#include "core/phantom/side.h"
#include "core/phantom/sign_list.h"

namespace dubsar::phantom {

enum class Label : std::uint8_t {
  kOutside = 0,
  kTablet = 1,    ///< clay
  kEnvelope = 2,  ///< clay
  kGap = 3,       ///< air between tablet and envelope, and in a crack of the envelope
  kPore = 4,
  kOrganic = 5,
  kGlue = 6,  ///< clay of both: where tablet and envelope join; on_tablet_side() says whose it was
};

enum class Owner : std::uint8_t { kTablet, kEnvelope };

/// What became of a wedge when the envelope was put on.
enum class WedgeCase : std::uint8_t {
  kFree,    ///< air from its place to its deepest point, or a gap that follows it and is no film
  kPocket,  ///< the envelope bridges it: air inside, at least half of its depth, closed above
  kFilm,    ///< a film of air along its walls
  kFilled,  ///< clay of the envelope in it, and no air, or air only at the bottom
};

inline constexpr EnumName<WedgeCase> kWedgeCases[] = {{WedgeCase::kFree, "free"},
                                                      {WedgeCase::kPocket, "pocket"},
                                                      {WedgeCase::kFilm, "film"},
                                                      {WedgeCase::kFilled, "filled"}};
static_assert(names_all(kWedgeCases, static_cast<std::size_t>(WedgeCase::kFilled) + 1));

/// Where a wedge begins and ends, on the undisturbed surface.
struct WedgePlace {
  glm::dvec3 head{0.0};   ///< middle of the head's straight edge
  glm::dvec3 end{0.0};    ///< where the tail, or a Winkelhaken's point, comes back to that surface
  glm::dvec3 right{0.0};  ///< unit, along the lines of its side
};

/// One wedge, in input voxel coordinates.
struct Wedge {
  glm::dvec3 position;  ///< on the undisturbed surface, above the deepest point
  glm::dvec3 outward;   ///< unit normal of that surface, towards the air
  glm::dvec3 tail;      ///< unit direction of the tail
  double depth = 0.0;   ///< voxels from `position` against `outward` to the clay, after all neighbours were written
  double length = 0.0;  ///< of the tail, voxels; 0: Winkelhaken
  double head_half_width = 0.0;
  WedgePlace place;
  StrokeKind kind = StrokeKind::kVertical;
  Side side = Side::kObverse;
  Owner owner = Owner::kTablet;
  std::int32_t sign = 0;               ///< running number of the sign it belongs to
  std::int32_t line = 0;               ///< of its block of text, from 1 at the top; blocks of a side count on
  bool open = true;                    ///< air from `position` to the deepest point
  WedgeCase state = WedgeCase::kFree;  ///< of the tablet's; those of the envelope's outside are free
  bool has_air() const noexcept { return state != WedgeCase::kFilled; }
};

/// A line that was ruled, in input voxel coordinates: places on the surface before it was, from left to right, as far
/// as at least half of its depth is there.
struct RuledLine {
  Owner owner = Owner::kTablet;
  Side side = Side::kObverse;
  std::vector<glm::dvec3> points;
  double depth = 0.0;  ///< voxels, where it is deepest
};

/// A band of the envelope that the seal was rolled along, in input voxel coordinates.
struct Sealing {
  Side side = Side::kObverse;
  glm::dvec3 from{0.0},
      to{0.0};  ///< ends of its middle line, where it is whole; on the surface before anything was pressed
};
/// Where a point lies in the seal's impression.
struct SealPlace {
  double x_mm = 0.0, y_mm = 0.0;  ///< along the rolling, from 0 to SealRelief::kTurnMm, and across
  double height_mm = 0.0;         ///< of the impression over its ground there, as the seal was cut
  bool shown = true;              ///< whole: not worn, not broken away, not rounded away with an edge
};

/// Fields at a point, in voxels, negative inside; metric to first order after division by their gradients near their
/// zero. Farther from it than the `reach` they were asked for they keep their sign, and are only known to be beyond it.
struct Fields {
  Dual tablet, outer, wall;  ///< tablet with its wedges, envelope seen from outside, cavity (negative in envelope clay)
  Dual pore, organic, grain;
  Dual crack;
  Dual clay;                 ///< all of it: negative in clay
  float tablet_base = 0.0f;  ///< the tablet before it was written on
};

Label label_of(const Fields& fields);

/// The nearest surface of a point, for judging a mesh.
enum class Part : std::uint8_t { kTablet, kEnvelopeOutside, kEnvelopeInside, kPore, kOrganic, kCrack };

class Phantom {
 public:
  /// Completes the options (see complete()) and builds the model: about 0.3 s, some MB. Errors: kUsage.
  static Result<std::unique_ptr<const Phantom>> create(const PhantomOptions& options);

  const PhantomOptions& options() const noexcept { return options_; }
  const std::vector<Wedge>& wedges() const noexcept { return wedges_; }
  /// Two of wedges() share some of their room. Those of one owner are in the order in which they were pressed.
  bool overlap(std::size_t first, std::size_t second) const;
  /// Part of the tablet's surface where there is no air between it and the envelope, or a film of it, 0..1.
  double glued_fraction() const noexcept { return glued_fraction_; }
  std::vector<RuledLine> ruled_lines() const;
  /// Of the envelope: obverse (above, below), reverse, upper edge, left edge.
  std::vector<Sealing> sealings() const;
  /// Of a point of the surface in the `sealing`-th band, within its height.
  std::optional<SealPlace> seal_place(std::size_t sealing, const glm::dvec3& point) const;
  bool cracked() const noexcept { return crack_.radius2 > 0.0f; }
  int pore_count() const noexcept { return static_cast<int>(pores_.all.size()); }

  // All points are in input voxel coordinates (voxel centres at integers). Any thread.

  /// Largest distance that signed_distance() reports.
  static constexpr double kReach = 4.0;
  /// Distance in voxels to the surface of the clay, negative in clay, cut to -kReach..kReach. The foot point is found
  /// by projection: within 2 voxels of the surface 98 % of all points are good to 0.05 voxel, the others lie near
  /// edges sharper than a voxel; beyond 2.5 voxels it is a first-order estimate. About 2 us near the surface, 0.2 us
  /// elsewhere.
  double signed_distance(const glm::dvec3& point) const;
  /// The same to the tablet alone, as if it were unwrapped.
  double tablet_distance(const glm::dvec3& point) const;

  Label label(const glm::dvec3& point) const;
  /// Inside the tablet as it was before the envelope was put on: tells the two sides of glued clay apart.
  bool on_tablet_side(const glm::dvec3& point) const;
  /// The surface nearest to the point. For points within some voxels of a surface.
  Part nearest_part(const glm::dvec3& point) const;
  /// Distance in voxels to where the tablet is glued to the envelope: how far the clay of one is from that of the
  /// other, negative where they overlap.
  double gap_width(const glm::dvec3& point) const;
  /// Tablet and envelope touch here, or there is a film between them.
  bool in_contact(const glm::dvec3& point) const { return touches(static_cast<float>(gap_width(point))); }

  /// All fields at a point. The smaller the reach, the faster: 0.1 to 0.4 us.
  Fields fields(float x, float y, float z, float reach = 20.0f) const;

 private:
  explicit Phantom(const PhantomOptions& options);
  friend class PhantomBuilder;

  /// Union of the impressions in `ids`: large when there are none.
  Dual impressions(const std::vector<Impression>& all, std::span<const std::uint32_t> ids, const Point& point,
                   const Dual& depth) const;
  Dual gap_at(const Point& point, const Dual& base) const;
  Dual carve(const Dual& body, const Dual& decor, const Dual& hollow) const;
  bool touches(float gap) const noexcept { return gap <= gap_.film; }
  template <class Field>
  double project(const glm::dvec3& point, const Field& field) const;

  PhantomOptions options_;
  ModelPlace place_;
  CellGrid grid_;
  SealRelief seal_;
  WrittenBody tablet_, outer_;
  ClayGap gap_;
  ClayEdges edges_;
  Strewn<Pore> pores_;
  Strewn<Straw> straws_;
  Strewn<Grain> grains_;
  Crack crack_;
  std::vector<Wedge> wedges_;
  double glued_fraction_ = 0.0;
};

}  // namespace dubsar::phantom
