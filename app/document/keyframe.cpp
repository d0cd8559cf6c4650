#include "app/document/keyframe.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/document/document_fields.h"
#include "app/document/document_file.h"
#include "core/base/text/json_text.h"
#include "input/navigation/view_state.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kFilmVersion = 2, kOldestFilm = 1;
constexpr std::string_view kFilmFormat = "dubsar film";

/// At t (0..1) of a cubic from a to b with the speeds `from` and `to` a second.
double cubic(double a, double b, double from, double to, double length, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * length * from + (-2 * t3 + 3 * t2) * b +
         (t3 - t2) * length * to;
}

/// The speed at a key between two steps: none where they go different ways, else their harmonic mean, which keeps the
/// curve between the keys.
double speed(double before, double length_before, double after, double length_after) {
  if (!(before * after > 0)) return 0.0;
  const double w1 = 2 * length_after + length_before, w2 = length_after + 2 * length_before;
  return (w1 + w2) / (w1 * length_before / before + w2 * length_after / after);
}

/// Four keys around a time, of which the outer ones may be missing.
struct Around {
  std::span<const Keyframe> keys;
  std::size_t at;  // of the key before
  double t;        // 0..1 to the next
  double length(std::size_t i) const { return keys[i + 1].time_s - keys[i].time_s; }

  /// `step(i)` is how far the number goes from key i to i + 1; the number grows from `first`.
  template <class Step>
  double number(double first, const Step& step) const {
    const double here = step(at);
    const double from = at == 0 ? 0.0 : speed(step(at - 1), length(at - 1), here, length(at));
    const double to = at + 2 >= keys.size() ? 0.0 : speed(here, length(at), step(at + 1), length(at + 1));
    return cubic(first, first + here, from, to, length(at), t);
  }
  template <class Get>
  double value(const Get& get) const {
    return number(get(keys[at]), [&](std::size_t i) { return get(keys[i + 1]) - get(keys[i]); });
  }
};

double shorter_way_deg(double turn) { return std::remainder(turn, 360.0); }

/// Turn from key i to the next, about the screen's axes.
glm::dvec3 turn_from(std::span<const Keyframe> keys, std::size_t i) {
  return vector_of(keys[i + 1].camera.rotation * glm::conjugate(keys[i].camera.rotation));
}

/// A cubic in turns: speeds at the keys are those of both neighbours, weighed by time, and none at the ends.
glm::dquat turned(const Around& around) {
  const auto speed_at = [&](std::size_t i) {
    if (i == 0 || i + 1 == around.keys.size()) return glm::dvec3(0.0);
    const double before = around.length(i - 1), after = around.length(i);
    return (turn_from(around.keys, i - 1) / before * after + turn_from(around.keys, i) / after * before) /
           (before + after);
  };
  const std::size_t i = around.at;
  const double third = around.length(i) / 3.0;
  const glm::dquat first = around.keys[i].camera.rotation, last = around.keys[i + 1].camera.rotation;
  const glm::dquat a = turn_of(third * speed_at(i)) * first, b = turn_of(-third * speed_at(i + 1)) * last;
  // De Casteljau on turns (K. Shoemake: Animating rotation with quaternion curves, 1985).
  const auto between = [&](const glm::dquat& p, const glm::dquat& q) {
    return turn_of(around.t * vector_of(q * glm::conjugate(p))) * p;
  };
  const glm::dquat ab = between(a, b);
  return glm::normalize(between(between(between(first, a), ab), between(ab, between(b, last))));
}

std::vector<KeyedPart> parts_between(const Around& around) {
  const auto named = [](const Keyframe& key, const std::string& name) -> const KeyedPart* {
    const auto at =
        std::find_if(key.parts.begin(), key.parts.end(), [&](const KeyedPart& part) { return part.name == name; });
    return at == key.parts.end() ? nullptr : &*at;
  };
  std::vector<KeyedPart> out;
  for (const KeyedPart& part : around.keys[around.at].parts) {
    if (named(around.keys[around.at + 1], part.name) == nullptr) {
      out.push_back(part);
      continue;
    }
    const auto of = [&](const Keyframe& key) -> const KeyedPart& {
      const KeyedPart* const found = named(key, part.name);
      return found != nullptr ? *found : part;
    };
    KeyedPart next{part.name, std::clamp(around.value([&](const Keyframe& key) { return of(key).opacity; }), 0.0, 1.0)};
    for (int a = 0; a < 3; ++a)
      next.offset_mm[a] = around.value([&](const Keyframe& key) { return of(key).offset_mm[a]; });
    out.push_back(std::move(next));
  }
  return out;
}

std::string style_at(std::span<const Keyframe> keys, std::size_t last) {
  for (std::size_t i = last + 1; i-- > 0;)
    if (!keys[i].style.empty()) return keys[i].style;
  return {};
}

/// What key i says or those before it; none: nobody says anything.
const KeyedShade* shade_of(std::span<const Keyframe> keys, std::size_t i) {
  for (std::size_t k = i + 1; k-- > 0;)
    if (keys[k].shade) return &*keys[k].shade;
  return nullptr;
}

/// From 0 to 1 without a jump of speed.
double eased(double t) { return t * t * (3.0 - 2.0 * t); }

std::optional<KeyedShade> shade_between(const Around& around) {
  const std::size_t i = around.at;
  const KeyedShade *const from = shade_of(around.keys, i), *const to = shade_of(around.keys, i + 1);
  if (from == nullptr) return std::nullopt;
  const auto mixes = [](const KeyedShade& s) { return s.share > 0 && !s.other.empty(); };
  const auto changes = [&](const KeyedShade& a, const KeyedShade& b) {
    return mixes(a) && mixes(b) && a.other != b.other;
  };
  const auto value = [&](const auto& get, bool rests) {  // `rests`: where the second style is another one next
    return around.number(get(*from), [&](std::size_t k) {
      const KeyedShade *const a = shade_of(around.keys, k), *const b = shade_of(around.keys, k + 1);
      return a == nullptr || b == nullptr || (rests && changes(*a, *b)) ? 0.0 : get(*b) - get(*a);
    });
  };
  KeyedShade out = *from;
  out.radiance = std::clamp(value([](const KeyedShade& s) { return s.radiance; }, false), 0.0, 2.0);
  out.strength = std::clamp(value([](const KeyedShade& s) { return s.strength; }, false), 0.0, 2.0);
  if (changes(*from, *to)) {
    const bool first = around.t < 0.5;
    out.other = first ? from->other : to->other;
    out.share = first ? from->share * eased(1.0 - 2.0 * around.t) : to->share * eased(2.0 * around.t - 1.0);
    return out;
  }
  out.other = mixes(*from) ? from->other : to->other;
  const auto share = [&](const KeyedShade& s) { return s.other == out.other ? s.share : 0.0; };
  out.share = std::clamp(value(share, true), 0.0, 1.0);
  return out;
}

std::string complaint_about(const KeyedShade& shade, std::size_t i) {
  const auto wrong = [i](const char* name, double found, int most) {
    return fmt::format("keyframes[{}].shade.{} is {}, expected 0 to {}", i, name, found, most);
  };
  if (!(shade.share >= 0 && shade.share <= 1)) return wrong("share", shade.share, 1);
  if (!(shade.radiance >= 0 && shade.radiance <= 2)) return wrong("radiance", shade.radiance, 2);
  if (!(shade.strength >= 0 && shade.strength <= 2)) return wrong("strength", shade.strength, 2);
  return {};
}

std::string complaint_about(std::span<const Keyframe> keys) {
  if (keys.empty()) return "no keyframe found, expected at least one";
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Keyframe& key = keys[i];
    if (!(key.camera.zoom > 0))
      return fmt::format("keyframes[{}].camera.zoom is {}, expected more than 0", i, key.camera.zoom);
    if (!(key.unpack >= 0 && key.unpack <= 1))
      return fmt::format("keyframes[{}].unpack is {}, expected 0 to 1", i, key.unpack);
    for (const KeyedPart& part : key.parts)
      if (!(part.opacity >= 0 && part.opacity <= 1))
        return fmt::format("keyframes[{}]: opacity of {} is {}, expected 0 to 1", i, part.name, part.opacity);
    if (key.shade)
      if (std::string wrong = complaint_about(*key.shade, i); !wrong.empty()) return wrong;
    if (i > 0 && !(key.time_s > keys[i - 1].time_s))
      return fmt::format("keyframes[{}].time_s is {}, expected more than {}", i, key.time_s, keys[i - 1].time_s);
  }
  return {};
}

struct Film {
  std::vector<Keyframe> keyframes;
};
void fields(auto& f, Film& v) { f("keyframes", v.keyframes); }

}  // namespace

Keyframe keyframe_of(const Document& document, double time_s) {
  Keyframe out{time_s, document.now, document.light, document.unpack, document.style.name, {}};
  for (const Part& part : document.parts)
    out.parts.push_back({part.name, part.visible ? part.opacity : 0.0, part.offset_mm});
  out.shade = KeyedShade{document.style.other, document.style.share, document.style.radiance, document.style.strength};
  return out;
}

void show_keyframe(Document& document, const Keyframe& frame) {
  document.now = frame.camera;
  document.light = frame.light;
  document.unpack = frame.unpack;
  if (!frame.style.empty()) document.style.name = frame.style;
  if (frame.shade) {
    document.style.other = frame.shade->other;
    document.style.share = frame.shade->share;
    document.style.radiance = frame.shade->radiance;
    document.style.strength = frame.shade->strength;
  }
  for (const KeyedPart& keyed : frame.parts)
    for (Part& part : document.parts) {
      if (part.name != keyed.name) continue;
      part.visible = keyed.opacity > 0.0;
      if (part.visible) part.opacity = keyed.opacity;
      part.offset_mm = keyed.offset_mm;
    }
}

Keyframe moment_at(std::span<const Keyframe> keys, double time_s) {
  DUBSAR_CHECK(!keys.empty());
  const auto after = std::upper_bound(keys.begin(), keys.end(), time_s,
                                      [](double time, const Keyframe& key) { return time < key.time_s; });
  const auto at = static_cast<std::size_t>(after - keys.begin());
  Keyframe out = at == 0 ? keys.front() : keys[at - 1];
  out.style = style_at(keys, at == 0 ? 0 : at - 1);
  const KeyedShade* const shade = shade_of(keys, at == 0 ? 0 : at - 1);
  out.shade = shade != nullptr ? std::optional(*shade) : std::nullopt;
  if (at == 0 || after == keys.end() || time_s == out.time_s) return out;
  const Around around{keys, at - 1, (time_s - out.time_s) / (after->time_s - out.time_s)};
  out.time_s = time_s;
  out.camera.rotation = turned(around);
  out.camera.zoom = std::exp(around.value([](const Keyframe& key) { return std::log(key.camera.zoom); }));
  for (int a = 0; a < 2; ++a) out.camera.pan[a] = around.value([a](const Keyframe& key) { return key.camera.pan[a]; });
  const double azimuth = around.number(keys[at - 1].light.azimuth_deg, [&](std::size_t i) {
    return shorter_way_deg(keys[i + 1].light.azimuth_deg - keys[i].light.azimuth_deg);
  });
  out.light.azimuth_deg = azimuth - 360.0 * std::floor(azimuth / 360.0);
  out.light.elevation_deg = around.value([](const Keyframe& key) { return key.light.elevation_deg; });
  out.unpack = std::clamp(around.value([](const Keyframe& key) { return key.unpack; }), 0.0, 1.0);
  out.parts = parts_between(around);
  out.shade = shade_between(around);
  return out;
}

double film_length_s(std::span<const Keyframe> keys) {
  return keys.size() < 2 ? 0.0 : keys.back().time_s - keys.front().time_s;
}

std::string format_film(std::span<const Keyframe> keys) {
  Film film{{keys.begin(), keys.end()}};
  stored::Writer writer;
  fields(writer, film);
  json out = writer.take();
  out["format"] = kFilmFormat;
  out["version"] = kFilmVersion;
  return dump_json_rows(out) + "\n";
}

Result<std::vector<Keyframe>> parse_film(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(text, source, kLargestDocument));
  const bool document = object.is_object() && object.contains("format") && object.at("format") == kDocumentFormat;
  Film film;
  if (document) {
    DUBSAR_ASSIGN(Document whole, parse_document(text, source));
    film.keyframes = std::move(whole.keyframes);
  } else {
    DUBSAR_TRY(json_version(object, kFilmFormat, kOldestFilm, kFilmVersion, source));
    std::string complaint;
    stored::Reader reader(object, "", complaint);
    fields(reader, film);
    if (!complaint.empty()) return fail(ErrorKind::kBadData, "{}: {}", source, complaint);
  }
  if (const std::string complaint = complaint_about(film.keyframes); !complaint.empty())
    return fail(ErrorKind::kBadData, "{}: {}", source, complaint);
  return std::move(film.keyframes);
}

}  // namespace dubsar::app
