// A person with a hand on the cap of a SpaceMouse.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/spacemouse/spacenav_server.h"
#include "input/simulated/scripted_wire.h"

namespace dubsar {
namespace {

constexpr double kFullDeflection_m = 0.05, kGrab = 0.8;
constexpr double kContent_rad = std::numbers::pi / 180.0, kContentZoom = 0.01, kFullTurn_rad = 0.5, kFullZoom = 0.5;
constexpr double kDeadZone = 0.05, kRest = 0.01;

struct Deflection {
  glm::dvec3 push{0.0}, twist{0.0};  ///< screen axes, -1..1
  bool operator==(const Deflection&) const = default;
};

class PuckWire : public ScriptedWire {
 public:
  explicit PuckWire(WireOptions options) : PuckWire(options, options.script.visitor) {}

 protected:
  virtual void send(const Deflection& cap) = 0;

 private:
  PuckWire(WireOptions& options, const std::optional<VisitorGoal>& goal) : ScriptedWire(without_visitor(options)) {
    if (!goal) return;
    constexpr double kRad = std::numbers::pi / 180.0;
    goal_ = *goal;
    wished_ = turn_of({goal->pitch_deg * kRad, 0, 0}) * turn_of({0, goal->yaw_deg * kRad, 0});
  }
  static WireOptions without_visitor(WireOptions options) {
    options.script.visitor.reset();
    return options;
  }

  void say(const InputFrame& frame) final {
    const Deflection cap = goal_ ? steered() : held(frame.hands);
    if (cap == Deflection{} && last_ == Deflection{}) return;  // a cap at rest says nothing
    last_ = cap;
    send(cap);
  }

  /// Towards the wished view, the harder the further away.
  Deflection steered() {
    const glm::dvec3 error = vector_of(wished_ * glm::conjugate(view().rotation));
    const double zoom = std::log(goal_->zoom / view().zoom);
    if (glm::length(error) <= kContent_rad && std::abs(zoom) <= kContentZoom) {
      end();
      return {};
    }
    return {{0.0, 0.0, pressed(zoom / kFullZoom)},
            {pressed(error.x / kFullTurn_rad), pressed(error.y / kFullTurn_rad), pressed(error.z / kFullTurn_rad)}};
  }
  /// Nobody presses less than it takes for something to happen.
  static double pressed(double wanted) {
    return std::abs(wanted) < kRest ? 0.0 : std::copysign(std::min(1.0, kDeadZone + std::abs(wanted)), wanted);
  }

  Deflection held(const Hands& hands) {
    if (hands.empty() || hands.front().grab_strength < kGrab) {
      grip_m_.reset();
      return {};
    }
    const glm::dvec3 at = hands.front().palm.position_m;
    if (!grip_m_) grip_m_ = at;
    const glm::dvec3 d = glm::clamp((at - *grip_m_) / kFullDeflection_m, -1.0, 1.0);
    return {{0.0, 0.0, d.z}, {-d.y, d.x, 0.0}};
  }

  std::optional<VisitorGoal> goal_;
  glm::dquat wished_{1, 0, 0, 0};
  std::optional<glm::dvec3> grip_m_;
  Deflection last_;
};

glm::ivec3 raw(const glm::dvec3& share) { return glm::ivec3(glm::round(share * double{kSpaceMouseFullScale})); }

class SpaceMouseWire final : public PuckWire {
 public:
  using PuckWire::PuckWire;
  Result<std::unique_ptr<Transport>> open() override { return sim_.device().open(); }

 private:
  /// Device axes: x right, y to the user, z down.
  static glm::ivec3 device_axes(const glm::dvec3& v) { return raw({v.x, v.z, -v.y}); }
  void send(const Deflection& cap) override { sim_.move(device_axes(cap.push), device_axes(cap.twist)); }
  SpaceMouseSim sim_;
};

class SpacenavWire final : public PuckWire {
 public:
  explicit SpacenavWire(WireOptions options) : PuckWire(std::move(options)) {
    SimBehaviour behaviour;
    behaviour.on_write = [this](std::span<const std::byte> bytes) -> Result<void> {
      if (const auto answer = side_.accept(bytes); !answer.empty()) device_.send(answer);
      return {};
    };
    device_.set_behaviour(std::move(behaviour));
  }
  Result<std::unique_ptr<Transport>> open() override {
    side_ = {};
    return device_.open();
  }

 private:
  /// The daemon's axes: z away from the user.
  static glm::ivec3 daemon_axes(const glm::dvec3& v) {
    return glm::ivec3(glm::round(glm::dvec3(v.x, v.y, -v.z) * double{kSpacenavFullScale}));
  }
  void send(const Deflection& cap) override {
    SpacenavEvent event;
    event.translation = daemon_axes(cap.push);
    event.rotation = daemon_axes(cap.twist);
    event.period_ms = 16;
    if (const auto bytes = side_.tell(event); !bytes.empty()) device_.send(bytes);
  }
  SpacenavServerSide side_;
  SimDevice device_{"simulated spacenavd", false};
};

}  // namespace

std::unique_ptr<SimulatedDevice> make_spacemouse_wire(WireOptions options) {
  return std::make_unique<SpaceMouseWire>(std::move(options));
}
std::unique_ptr<SimulatedDevice> make_spacenav_wire(WireOptions options) {
  return std::make_unique<SpacenavWire>(std::move(options));
}

}  // namespace dubsar
