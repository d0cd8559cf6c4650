#include "display/sinks/openxr.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"

namespace dubsar {
namespace {

constexpr double kNearMm = 30.0, kFarMm = 20'000.0;
constexpr PixelSize kNominalEye{1440, 1600};  // until a headset was found
constexpr double kNominalHeightMm = 300.0;    // of what a first camera shows while nobody wears the headset
constexpr auto kNobodyThere = std::chrono::milliseconds(10);

class OpenXrSink final : public OutputSink {
 public:
  OpenXrSink(std::unique_ptr<Headset> headset, const HeadsetPlace& place)
      : headset_(std::move(headset)), place_(place) {}

  SinkTraits traits() const noexcept override {
    return {.name = "openxr",
            .views = 2,
            .view = eye_,
            .output = {screen_.window_w, screen_.window_h},
            .own_size = true,
            .aspect = static_cast<double>(eye_.width) / eye_.height,
            .worn = true,
            .see_through = place_.see_through};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = screen;
    if (headset_->eye_size().width > 0) eye_ = headset_->eye_size();
    nominal_ = true;
    wearer_.reset();
    return {};
  }
  /// The first ones after configure() are cameras of somebody before the place; then those of the wearer.
  std::span<const View> views(const Observer& viewer) override {
    if (std::exchange(nominal_, false) || !begin()) {
      const double half_h = 0.5 * kNominalHeightMm, half_w = half_h * eye_.width / eye_.height;
      const WindowRect window{{-half_w, -half_h, 0}, {half_w, -half_h, 0}, {-half_w, half_h, 0}};
      return views_ = {viewer_view(window, viewer, viewer.left_mm), viewer_view(window, viewer, viewer.right_mm)};
    }
    return views_ = {eye_view(wearer_->eyes[0]), eye_view(wearer_->eyes[1])};
  }

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    if (wearer_) DUBSAR_TRY(headset_->end(views));
    return mirror(views, target);
  }
  std::optional<WearerFrame> wearer() const override { return wearer_; }
  void recentre() override { placed_ = false; }
  std::string note() const override { return headset_->reason(); }
  bool outdated() const override {
    const PixelSize eye = headset_->eye_size();
    return eye.width > 0 && eye != eye_;
  }
  bool hidden() const override { return wearer_ && !wearer_->seen; }
  bool ended() const override { return headset_->ended(); }

 private:
  bool begin() {
    const auto frame = headset_->begin();
    wearer_.reset();
    if (!frame) {
      std::this_thread::sleep_for(kNobodyThere);  // nothing else paces the pictures
      return false;
    }
    if (!placed_ || frame->recentred) {
      const Pose head{0.5 * (frame->eyes[0].pose.position_m + frame->eyes[1].pose.position_m),
                      frame->eyes[0].pose.rotation};
      const std::optional<Pose> panel = panel_before(frame->eyes);
      room_from_screen_ = panel ? *panel : room_from_screen(head, frame->floor_m, place_);
      on_panel_ = panel.has_value();
      placed_ = true;
    }
    wearer_ = moved_to_screen(*frame, room_from_screen_);
    if (on_panel_) wearer_->floor_m.reset();  // there is no room to be seen, and no table in it
    return true;
  }

  /// The left eye's view, as large as fits.
  Result<void> mirror(const ViewArray& views, const Surface& target) {
    if (target.width < 1 || target.height < 1) return {};  // minimised
    const GlFramebuffer from = make_framebuffer();
    glNamedFramebufferTextureLayer(from, GL_COLOR_ATTACHMENT0, views.coded(), 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const double scale = std::min(static_cast<double>(target.width) / views.width(),
                                  static_cast<double>(target.height) / views.height());
    const int width = static_cast<int>(scale * views.width()), height = static_cast<int>(scale * views.height());
    const int x = (target.width - width) / 2, y = (target.height - height) / 2;
    glBlitNamedFramebuffer(from, target.framebuffer, 0, 0, views.width(), views.height(), x, y, x + width, y + height,
                           GL_COLOR_BUFFER_BIT, GL_LINEAR);
    return check_gl("mirroring a headset");
  }

  std::unique_ptr<Headset> headset_;
  HeadsetPlace place_;
  Screen screen_;
  PixelSize eye_ = kNominalEye;
  std::array<View, 2> views_;
  std::optional<WearerFrame> wearer_;  ///< of the frame that was begun, in the screen's frame
  Pose room_from_screen_;
  bool placed_ = false, on_panel_ = false, nominal_ = true;
};

}  // namespace

Pose room_from_screen(const Pose& head, const std::optional<double>& floor_m, const HeadsetPlace& place) {
  constexpr double kUpright = 0.2;  // of a unit vector that is too steep to say a direction
  glm::dvec3 ahead = head.rotation * glm::dvec3(0, 0, -1);
  if (std::hypot(ahead.x, ahead.z) < kUpright)
    ahead = (ahead.y < 0 ? 1.0 : -1.0) * (head.rotation * glm::dvec3(0, 1, 0));
  ahead.y = 0;
  ahead = glm::normalize(ahead);
  Pose out;
  out.position_m = head.position_m + place.distance_m * ahead;
  const double lowest = head.position_m.y - place.distance_m * std::tan(glm::radians(place.steepest_deg));
  out.position_m.y = std::max(lowest, floor_m ? *floor_m + place.height_m : head.position_m.y - place.below_m);
  const double turn = std::atan2(-ahead.x, -ahead.z);  // about +Y, from +Z to the wearer
  out.rotation = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
  return out;
}

std::optional<Pose> panel_before(const std::array<HeadsetEye, 2>& eyes) {
  constexpr double kParallel = 1e-4, kSame = 0.02, kNearest = 0.1, kFarthest = 10.0;  // m
  const auto& [left, right] = eyes;
  if (std::abs(std::abs(glm::dot(left.pose.rotation, right.pose.rotation)) - 1.0) > kParallel) return std::nullopt;
  const glm::dvec3 apart =
      glm::conjugate(left.pose.rotation) * (right.pose.position_m - left.pose.position_m);  // in the eyes' frame
  // The left eye sees less to the left and more to the right of a window than the right one does.
  const double by_left_edge = apart.x / (left.left - right.left), by_right_edge = apart.x / (left.right - right.right);
  const double distance = 0.5 * (by_left_edge + by_right_edge);
  if (!(distance > kNearest && distance < kFarthest) || std::abs(by_left_edge - by_right_edge) > kSame * distance)
    return std::nullopt;
  const glm::dvec3 middle(0.5 * (left.left + left.right) * distance, 0.5 * (left.down + left.up) * distance, -distance);
  return Pose{left.pose.position_m + left.pose.rotation * middle, left.pose.rotation};
}

WearerFrame moved_to_screen(const WearerFrame& room, const Pose& room_from_screen) {
  const Pose screen_from_room = inverse(room_from_screen);
  WearerFrame out = room;
  for (HeadsetEye& eye : out.eyes) eye.pose = compose(screen_from_room, eye.pose);
  for (WornHand& hand : out.hands)
    for (WornJoint& joint : hand.joints) joint.pose = compose(screen_from_room, joint.pose);
  for (WornController& controller : out.controllers) controller.grip = compose(screen_from_room, controller.grip);
  if (out.floor_m) *out.floor_m -= room_from_screen.position_m.y;
  return out;
}

View eye_view(const HeadsetEye& eye) {
  const glm::dmat4 screen_from_eye =
      glm::translate(glm::dmat4(1.0), 1e3 * eye.pose.position_m) * glm::mat4_cast(eye.pose.rotation);
  return {glm::inverse(screen_from_eye),
          glm::frustum(kNearMm * eye.left, kNearMm * eye.right, kNearMm * eye.down, kNearMm * eye.up, kNearMm, kFarMm)};
}

std::unique_ptr<OutputSink> openxr_sink(std::unique_ptr<Headset> headset, const HeadsetPlace& place) {
  return std::make_unique<OpenXrSink>(std::move(headset), place);
}

Result<std::unique_ptr<OutputSink>> make_openxr_sink(SinkOptions options) {
  HeadsetPlace place;
  place.distance_m = options.number("distance", 0.2, 5.0, place.distance_m);
  place.height_m = options.number("height", 0.0, 3.0, place.height_m);
  HeadsetWish wish;
  const std::string blend = options.text("blend").value_or("opaque");
  wish.see_through = blend == "alpha"      ? SeeThrough::kAlpha
                     : blend == "additive" ? SeeThrough::kAdditive
                                           : SeeThrough::kNo;
  if (wish.see_through == SeeThrough::kNo && blend != "opaque")
    return fail(ErrorKind::kUsage, "display openxr: blend={} found, expected opaque, alpha or additive", blend);
  const std::string graphics = options.text("graphics").value_or("any");
  wish.graphics = graphics == "gl"       ? SessionGraphics::kGl
                  : graphics == "vulkan" ? SessionGraphics::kVulkan
                                         : SessionGraphics::kAny;
  if (wish.graphics == SessionGraphics::kAny && graphics != "any")
    return fail(ErrorKind::kUsage, "display openxr: graphics={} found, expected gl, vulkan or any", graphics);
  DUBSAR_TRY(options.finish("distance=, height=, blend=opaque|alpha|additive, graphics=gl|vulkan|any"));
  place.see_through = wish.see_through != SeeThrough::kNo;
  DUBSAR_ASSIGN(auto headset, make_headset(wish));
  return openxr_sink(std::move(headset), place);
}

}  // namespace dubsar
