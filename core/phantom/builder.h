#pragma once
// Builds the model: sizes, text, seals, gap, pores. Part of phantom.cpp's house; not for users.

#include "core/phantom/phantom.h"
#include "core/phantom/sign_list.h"

namespace dubsar::phantom {

class PhantomBuilder {
 public:
  /// `options` are complete.
  static std::unique_ptr<const Phantom> build(const PhantomOptions& options);

 private:
  explicit PhantomBuilder(Phantom& phantom) : p_(phantom) {}
  // builder.cpp: clay
  void place_in_grid();
  void shape_bodies();
  void shape_gap();
  void measure_glue();
  void index_wedges();
  void fill_clay();
  void crack_envelope();
  void wear_sealings();  // sealings.cpp
  // text_layout.cpp: writing
  void write_tablet();
  void write_envelope();
  struct TextBlock {
    Side side;
    float top, half_length;  ///< voxels along up and right
    int lines;
    double fill;         ///< share of lines that are written
    int first_line = 1;  ///< number of its first line on the side
  };
  void write_block(Owner owner, const TextBlock& block);
  struct PressedAs {
    int sign, line;
    float sign_height;
  };
  void press(Owner owner, Side side, float right, float up, const Stroke& stroke, const PressedAs& as);
  void measure_wedges();

  float mm(double length) const { return static_cast<float>(length) * p_.place_.voxels_per_mm; }
  std::uint64_t seed() const { return p_.options_.seed; }

  Phantom& p_;
  float line_pitch_ = 0.0f, tip_rounding_ = 1.0f;
  std::vector<Ball> tablet_balls_, outer_balls_;
  int signs_ = 0;
};

}  // namespace dubsar::phantom
