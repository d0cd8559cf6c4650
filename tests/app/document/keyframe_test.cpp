// Films as values: what they pass through, how they move, and their files.

#include "app/document/keyframe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "app/document/document_file.h"

namespace dubsar::app {
namespace {

std::vector<Keyframe> some_film(unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  std::vector<Keyframe> out;
  double time = real(-2, 2);
  for (int i = 0; i < 6; ++i) {
    Keyframe key;
    key.time_s = time;
    time += real(0.2, 4);
    key.camera = {turn_of({real(-2, 2), real(-2, 2), real(-2, 2)}), real(0.3, 8), {real(-1, 1), real(-1, 1)}};
    key.light = {real(0, 360), real(5, 85)};
    key.unpack = real(0, 1);
    key.style = i % 2 == 0 ? "relief" : "";
    key.parts = {{"tablet", 1.0, {}}, {"envelope", real(0, 1), {std::round(1e3 * real(-9, 9)) / 1e3, 0, 0}}};
    key.shade = KeyedShade{i < 4 ? "raking" : "msii", real(0.1, 1), real(0, 2), real(0, 2)};
    out.push_back(key);
  }
  return out;
}

double apart_deg(const CameraPose& a, const CameraPose& b) { return turn_between_deg(a.rotation, b.rotation); }

TEST(Film, PassesThroughItsKeysAndRestsBeforeAndAfter) {
  const auto film = some_film(std::random_device()());
  for (std::size_t i = 0; i < film.size(); ++i) {
    Keyframe there = moment_at(film, film[i].time_s);
    EXPECT_EQ(there.style, "relief");
    there.style = film[i].style;
    EXPECT_EQ(there, film[i]) << i;
    for (const double before : {1e-9, -1e-9}) {
      const Keyframe near = moment_at(film, film[i].time_s + before);
      EXPECT_LT(apart_deg(near.camera, film[i].camera), 1e-4);
      EXPECT_NEAR(near.camera.zoom, film[i].camera.zoom, 1e-6);
      EXPECT_NEAR(near.parts[1].offset_mm.x, film[i].parts[1].offset_mm.x, 1e-5);
    }
  }
  EXPECT_EQ(moment_at(film, -1e5).camera, film.front().camera);
  EXPECT_EQ(moment_at(film, 1e5).camera, film.back().camera);
  EXPECT_DOUBLE_EQ(film_length_s(film), film.back().time_s - film.front().time_s);
  EXPECT_EQ(film_length_s(std::span(film).first(1)), 0.0);
}

TEST(Film, SpeedHasNoJumpsAndEndsAtRest) {
  const auto film = some_film(11);
  const double h = 1e-5;
  const auto speeds = [&](double t) {  // degrees, logarithm of zoom, heights, unpack, mm a second
    const Keyframe a = moment_at(film, t), b = moment_at(film, t + h);
    const glm::dvec3 turn = vector_of(b.camera.rotation * glm::conjugate(a.camera.rotation)) / h;
    return std::array{turn.x,
                      turn.y,
                      turn.z,
                      std::log(b.camera.zoom / a.camera.zoom) / h,
                      (b.camera.pan.x - a.camera.pan.x) / h,
                      std::remainder(b.light.azimuth_deg - a.light.azimuth_deg, 360.0) / h / 57.3,
                      (b.unpack - a.unpack) / h,
                      (b.parts[1].offset_mm.x - a.parts[1].offset_mm.x) / h,
                      (b.shade->share - a.shade->share) / h,
                      (b.shade->radiance - a.shade->radiance) / h,
                      (b.shade->strength - a.shade->strength) / h};
  };
  for (std::size_t i = 0; i < film.size(); ++i) {
    const auto before = speeds(film[i].time_s - 2 * h), after = speeds(film[i].time_s + h);
    for (std::size_t c = 0; c < before.size(); ++c) {
      EXPECT_NEAR(before[c], after[c], 2e-2) << "key " << i << " component " << c;
      if (i == 0 || i + 1 == film.size()) {
        EXPECT_NEAR(before[c] + after[c], 0.0, 2e-2) << "the ends are at rest";
      }
    }
  }
}

TEST(Film, NumbersStayBetweenTheirKeysAndTurnsTakeTheShorterWay) {
  for (unsigned seed = 1; seed < 30; ++seed) {
    const auto film = some_film(seed);
    for (std::size_t i = 0; i + 1 < film.size(); ++i)
      for (double t = 0; t <= 1; t += 0.05) {
        const Keyframe now = moment_at(film, film[i].time_s + t * (film[i + 1].time_s - film[i].time_s));
        const auto between = [&](double a, double x, double b) {
          EXPECT_GE(x, std::min(a, b) - 1e-9);
          EXPECT_LE(x, std::max(a, b) + 1e-9);
        };
        between(film[i].unpack, now.unpack, film[i + 1].unpack);
        between(film[i].camera.zoom, now.camera.zoom, film[i + 1].camera.zoom);
        between(film[i].light.elevation_deg, now.light.elevation_deg, film[i + 1].light.elevation_deg);
        between(film[i].parts[1].opacity, now.parts[1].opacity, film[i + 1].parts[1].opacity);
        between(film[i].shade->radiance, now.shade->radiance, film[i + 1].shade->radiance);
        between(film[i].shade->strength, now.shade->strength, film[i + 1].shade->strength);
        if (film[i].shade->other == film[i + 1].shade->other)
          between(film[i].shade->share, now.shade->share, film[i + 1].shade->share);
        EXPECT_NEAR(glm::length(now.camera.rotation), 1.0, 1e-12);
      }
  }
  std::vector<Keyframe> light(2);
  light[0].light = {350, 20};
  light[1].light = {10, 20};
  light[1].time_s = 1;
  EXPECT_NEAR(moment_at(light, 0.5).light.azimuth_deg, 0.0, 1e-9) << "over the top, not round the bottom";
  light[1].camera.rotation = turn_of({0, 1.0, 0});
  EXPECT_NEAR(turn_between_deg(moment_at(light, 0.5).camera.rotation, turn_of({0, 0.5, 0})), 0.0, 1e-9);
}

TEST(Film, ASecondStyleFadesInAndOutAndGivesWayToAnother) {
  std::vector<Keyframe> film(4);
  for (std::size_t i = 0; i < film.size(); ++i) film[i].time_s = static_cast<double>(i);
  film[0].shade = KeyedShade{};
  film[1].shade = KeyedShade{"raking", 0.8, 1.0, 1.0};
  film[2].shade = KeyedShade{"msii", 0.4, 0.0, 1.0};
  film[3].shade = KeyedShade{};
  const auto at = [&](double time) { return *moment_at(film, time).shade; };
  EXPECT_EQ(at(0.5).other, "raking") << "it comes in from nothing";
  EXPECT_NEAR(at(0.5).share, 0.4, 0.1);
  EXPECT_NEAR(at(0.5).radiance, 0.5, 0.1);
  EXPECT_EQ(at(1.25).other, "raking");
  EXPECT_NEAR(at(1.25).share, 0.4, 1e-9);
  EXPECT_NEAR(at(1.5).share, 0.0, 1e-9) << "half-way neither of them is seen, so that none jumps";
  EXPECT_EQ(at(1.75).other, "msii");
  EXPECT_NEAR(at(1.75).share, 0.2, 1e-9);
  EXPECT_EQ(at(2.5).other, "msii") << "it goes";
  EXPECT_NEAR(at(2.5).share, 0.2, 0.05);
  double before = 0.0;
  std::string name;
  for (double time = 0; time <= 3; time += 1e-3) {
    const KeyedShade now = at(time);
    EXPECT_NEAR(now.share, before, 0.005) << "no jump at " << time;
    if (now.other != name) {
      EXPECT_LT(before, 0.005) << time;
    }
    before = now.share;
    name = now.other;
  }
  film[1].shade.reset();  // it says nothing: as before
  film[2].shade.reset();
  EXPECT_EQ(at(2.0), KeyedShade{});
}

TEST(Film, OneThatWasMadeBeforeShadesWereKeptIsReadAndChangesNone) {
  auto film = some_film(3);
  for (Keyframe& key : film) key.shade.reset();
  std::string text = format_film(film);
  text.replace(text.find("\"version\": 2"), 12, "\"version\": 1");
  const auto back = parse_film(text, "old");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, film);
  EXPECT_FALSE(moment_at(*back, film[1].time_s + 0.1).shade);
  Document document;
  document.style.other = "raking";
  document.style.share = 0.3;
  document.style.radiance = 0.7;
  const StyleChoice before = document.style;
  show_keyframe(document, back->front());
  EXPECT_EQ(document.style, before) << "as the session has it";
}

TEST(Film, IsWhatTheDocumentShowsAndBack) {
  Document document;
  document.parts = {{"tablet", 1}, {"envelope", 6, false, {255, 255, 255}, 0.5, {0, 0, 7}}};
  document.now = {turn_of({0.1, 0.2, 0.3}), 2.0, {0.1, 0.2}};
  document.light = {90, 15};
  document.unpack = 0.25;
  document.style.name = "raking";
  document.style.other = "msii";
  document.style.share = 0.3;
  document.style.radiance = 1.2;
  document.style.strength = 0.5;
  const Keyframe frame = keyframe_of(document, 3.0);
  EXPECT_EQ(frame.parts[1].opacity, 0.0) << "not there";
  Document other;
  other.parts = {{"tablet", 1}, {"envelope", 6}};
  show_keyframe(other, frame);
  EXPECT_EQ(keyframe_of(other, 3.0), frame);
  EXPECT_FALSE(other.parts[1].visible);
  EXPECT_EQ(other.style, document.style);
}

TEST(Film, FilesAreExactAndMistakesAreSentences) {
  const auto film = some_film(std::random_device()());
  const std::string text = format_film(film);
  const auto back = parse_film(text, "film");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, film);
  Document document;
  document.keyframes = film;
  EXPECT_EQ(parse_film(format_document(document), "document").value(), film) << "a session's file is a film, too";
  for (std::size_t n = 0; n + 2 < text.size(); n += 3) EXPECT_FALSE(parse_film(text.substr(0, n), "cut")) << n;
  const auto refusal = [&](auto change) {
    auto changed = film;
    change(changed);
    const auto parsed = parse_film(format_film(changed), "f.json");
    return parsed ? std::string("accepted") : parsed.error().message;
  };
  EXPECT_EQ(refusal([](auto& f) { f.clear(); }), "f.json: no keyframe found, expected at least one");
  EXPECT_EQ(refusal([](auto& f) { f[1].unpack = 2; }), "f.json: keyframes[1].unpack is 2, expected 0 to 1");
  EXPECT_EQ(refusal([](auto& f) { f[0].camera.zoom = 0; }),
            "f.json: keyframes[0].camera.zoom is 0, expected more than 0");
  EXPECT_EQ(refusal([](auto& f) {
              f[1].time_s = 4;
              f[2].time_s = 4;
              f[0].time_s = 3;
            }),
            "f.json: keyframes[2].time_s is 4, expected more than 4");
  EXPECT_EQ(refusal([](auto& f) { f[1].shade->share = 1.5; }),
            "f.json: keyframes[1].shade.share is 1.5, expected 0 to 1");
  EXPECT_EQ(refusal([](auto& f) { f[3].shade->radiance = -1; }),
            "f.json: keyframes[3].shade.radiance is -1, expected 0 to 2");
  EXPECT_FALSE(parse_film("[]", "x"));
  EXPECT_FALSE(parse_film(R"({"format": "dubsar film", "version": 3, "keyframes": []})", "x"));
}

}  // namespace
}  // namespace dubsar::app
