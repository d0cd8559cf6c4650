// A reader that throws costs its source, not the session.

#include <stdexcept>
#include <thread>

#include "input/sources/threaded_source.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

class Thrower final : public SourceReader {
 public:
  explicit Thrower(int good) : good_(good) {}
  bool read(TimestampNs now, milliseconds, InputFrame& frame) override {
    if (good_-- == 0) throw std::logic_error("index 7 of 3");
    frame.time = now;
    frame.space_mouse = SpaceMouseMotion{now, {1, 0, 0}, {}};
    return true;
  }
  bool connected() const override { return true; }
  std::string reason() const override { return {}; }
  void wake() override {}

 private:
  int good_;
};

TEST(BrokenReader, AnExceptionIsALossWithItsReason) {
  SourceBench bench;
  const auto source = make_threaded_source({.name = "thrower"}, std::make_unique<Thrower>(2), bench.config);
  ASSERT_TRUE(source->start());
  EXPECT_EQ(bench.poll(*source), Freshness::kNew);
  EXPECT_EQ(bench.poll(*source), Freshness::kNew);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.poll(*source), Freshness::kLost);
  EXPECT_FALSE(bench.frame.space_mouse);
  EXPECT_EQ(source->note(), "thrower: reading has stopped by a mistake of this program: index 7 of 3");
}

TEST(BrokenReader, InAThreadOfItsOwnToo) {
  const auto source = make_threaded_source({.name = "thrower"}, std::make_unique<Thrower>(0), {});
  ASSERT_TRUE(source->start());
  InputFrame frame;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (source->note().find("index 7") == std::string::npos && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(source->poll(0, frame), Freshness::kLost);
  EXPECT_NE(source->note().find("index 7"), std::string::npos) << source->note();
}

}  // namespace
}  // namespace dubsar::test
