#pragma once
// What a museum says about its kiosk, in one JSON file.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/kiosk/quiet_hours.h"
#include "core/base/text/json_fields.h"

namespace dubsar::app {

/// Texts by language.
using Texts = std::map<std::string, std::string, std::less<>>;
/// The member `name` of `object`, whose fields these are: a text, which is English, or texts by language, each of at
/// most 400 bytes. Missing: none.
Texts read_texts(JsonFields& fields, const nlohmann::json& object, const char* name);

struct KioskObject {
  std::filesystem::path file, tour{};  ///< surface; tour.h, empty: the one that any tablet has
  bool toured = true;                  ///< false: none at all
  Texts title{};
  std::vector<std::string> parts{};  ///< shown; empty: all
  std::string style = "relief";
};

/// A further panel that shows the same.
struct KioskPanel {
  std::string display, monitor{}, size{};  ///< as of `dubsar view --also`
};

struct VisitorEyes {
  double reading_distance_m = 1.5;
  double parallax_deg = 1.0;  ///< that they may converge more or less than on the panel, 0.1..3
};

/// Code of others that runs as part of the kiosk.
struct KioskPlugins {
  std::vector<std::string> plugins{};  ///< shared libraries with displays
};

struct KioskProfile : KioskPlugins {
  std::vector<KioskObject> objects;          ///< at least one
  std::vector<std::string> languages{"en"};  ///< the first one is spoken at first
  std::filesystem::path words{};             ///< changes to the program's sentences; empty: none
  std::string display = "mono", monitor{};   ///< as of `dubsar view`; monitor empty: where the panel is
  std::vector<KioskPanel> panels{};
  std::vector<std::string> inputs{};  ///< as of `dubsar view --input`; empty: what is plugged in, no keyboard
  double idle_reset_s = 90.0;         ///< without a hand, until all is as at the beginning
  double attract_after_s = 8.0;       ///< without a hand, until the object moves by itself
  std::vector<QuietHours> quiet{};
  double brightness = 1.0;  ///< 0.1..1
  VisitorEyes eyes{};
  std::string pin{};                 ///< 4 to 12 digits; empty: no menu by keys
  std::filesystem::path key_file{};  ///< a file whose presence opens the operator's menu; empty: none
  std::filesystem::path journal{};   ///< folder; empty: none
};

/// Something wrong in a profile: at a place as of JsonPlaces, in one sentence.
struct ProfileFault {
  std::string place, what;
};
/// What can be read of a profile; everything wrong with it is added to `faults`. Relative paths count from `folder`,
/// that of the profile.
KioskProfile take_kiosk_profile(const nlohmann::json& object, const std::filesystem::path& folder,
                                std::vector<ProfileFault>& faults);

/// The same of a text, which has nothing wrong: kConfig in one sentence, with line and column, for what is unknown,
/// missing or out of range; whether files exist is not looked at.
Result<KioskProfile> parse_kiosk_profile(std::string_view json_text, std::string_view source,
                                         const std::filesystem::path& folder);

/// kNoInput, kPermission, kConfig; also looks whether the objects, tours and words are there.
Result<KioskProfile> read_kiosk_profile(const std::filesystem::path& path);

/// The text in the language, else in English, else any; empty when there is none.
std::string_view text_in(const Texts& texts, std::string_view language) noexcept;

}  // namespace dubsar::app
