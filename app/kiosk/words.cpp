#include "app/kiosk/words.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kLongestLine = 120;

struct Sentence {
  Line line;
  std::string_view name, en, de, fr;
};

constexpr std::array<Sentence, kLineCount> kSentences{{
    {Line::kInvite, "invite", "Reach out your hand: turn the tablet yourself",
     "Hand ausstrecken und die Tafel selbst drehen", "Tendez la main : tournez vous-même la tablette"},
    {Line::kShowHand, "show_hand", "Hold your open hand before the sensor", "Halten Sie die offene Hand vor den Sensor",
     "Tenez la main ouverte devant le capteur"},
    {Line::kGrab, "grab", "Close your hand: you take hold of the tablet", "Hand schließen: Sie halten die Tafel",
     "Fermez la main : vous saisissez la tablette"},
    {Line::kTurn, "turn", "Move your fist: the tablet turns with it", "Faust bewegen: die Tafel dreht sich mit",
     "Déplacez le poing : la tablette tourne avec lui"},
    {Line::kTwoHands, "two_hands", "Pull two fists apart: the tablet grows",
     "Zwei Fäuste auseinander: die Tafel wächst", "Écartez deux poings : la tablette grandit"},
    {Line::kSwipe, "swipe", "Wipe with the open hand: the next side", "Mit offener Hand wischen: die nächste Seite",
     "Balayez de la main ouverte : la face suivante"},
    {Line::kRest, "rest", "Hold your open hand on the sign: the envelope opens",
     "Offene Hand auf das Zeichen: die Hülle öffnet sich", "Main ouverte sur le signe : l'enveloppe s'ouvre"},
    {Line::kRestTour, "rest_tour", "Hold your open hand on the triangle: a tour begins",
     "Offene Hand auf das Dreieck: ein Rundgang beginnt", "Main ouverte sur le triangle : une visite commence"},
    {Line::kNearer, "nearer", "A little nearer, please", "Bitte etwas näher", "Un peu plus près, s'il vous plaît"},
    {Line::kOpenFirst, "open_first", "Open your hand first", "Öffnen Sie zuerst die Hand", "Ouvrez d'abord la main"},
    {Line::kSomebodyElse, "somebody_else", "Somebody else holds it: you are next",
     "Jemand anders hält die Tafel: gleich Sie", "Quelqu'un la tient : bientôt votre tour"},
    {Line::kTouch, "touch", "Touch the glass: one finger turns the tablet, two bring it nearer",
     "Glas berühren: Ein Finger dreht die Tafel, zwei holen sie heran",
     "Touchez la vitre : un doigt tourne la tablette, deux la rapprochent"},
    {Line::kNoTracker, "no_tracker", "The hand sensor is missing; the tablet turns by itself",
     "Der Handsensor fehlt; die Tafel dreht sich von selbst", "Le capteur manque ; la tablette tourne toute seule"},
    {Line::kNoPanel, "no_panel", "The display is not the one that was set up: this picture is flat",
     "Die Anzeige ist nicht die eingerichtete: dieses Bild ist flach",
     "L'écran n'est pas celui qui a été réglé : cette image est plate"},
    {Line::kNoObject, "no_object", "This object cannot be shown today", "Dieses Stück kann heute nicht gezeigt werden",
     "Cet objet ne peut pas être montré aujourd'hui"},
    {Line::kTourSealed, "tour_sealed", "A sealed envelope", "Eine versiegelte Hülle", "Une enveloppe scellée"},
    {Line::kTourSealedText, "tour_sealed_text", "Clay around clay: nobody has read what is inside since it was closed.",
     "Ton um Ton: Seit sie verschlossen wurde, hat niemand gelesen, was darin ist.",
     "De l'argile autour de l'argile : personne n'a lu l'intérieur depuis qu'elle fut fermée."},
    {Line::kTourSeals, "tour_seals", "Seals and signs", "Siegel und Zeichen", "Sceaux et signes"},
    {Line::kTourSealsText, "tour_seals_text", "Pressed into wet clay on every side. Low light shows them.",
     "Rundum in den feuchten Ton gedrückt. Flaches Licht macht sie sichtbar.",
     "Imprimés dans l'argile humide, sur chaque face. La lumière rasante les révèle."},
    {Line::kTourPeel, "tour_peel", "The envelope opens", "Die Hülle öffnet sich", "L'enveloppe s'ouvre"},
    {Line::kTourPeelText, "tour_peel_text", "Nobody breaks it: X-rays have seen through the clay.",
     "Niemand zerbricht sie: Röntgenstrahlen haben durch den Ton gesehen.",
     "Personne ne la brise : les rayons X ont traversé l'argile."},
    {Line::kTourTablet, "tour_tablet", "The tablet inside", "Die Tafel darin", "La tablette cachée"},
    {Line::kTourTabletText, "tour_tablet_text",
     "Written, then wrapped. Where both stuck together the clay is paler: nobody knows the writing.",
     "Beschrieben, dann umhüllt. Wo beides klebt, ist der Ton blasser: Die Schrift kennt niemand.",
     "Écrite, puis enveloppée. Où elles collent, l'argile est plus pâle : écriture inconnue."},
    {Line::kTourBare, "tour_bare", "A tablet of clay", "Eine Tafel aus Ton", "Une tablette d'argile"},
    {Line::kTourBareText, "tour_bare_text", "All six sides may carry text: it is turned upwards, not like a page.",
     "Alle sechs Seiten können Text tragen: Man dreht sie nach oben, nicht wie ein Blatt.",
     "Ses six faces peuvent porter du texte : on la tourne vers le haut, pas comme une page."},
    {Line::kTourLine, "tour_line", "A line is read", "Eine Zeile wird gelesen", "Une ligne se lit"},
    {Line::kTourLineText, "tour_line_text", "From left to right: light from the side shows each wedge of a sign.",
     "Von links nach rechts: Licht von der Seite zeigt jeden Keil eines Zeichens.",
     "De gauche à droite : la lumière latérale montre chaque coin d'un signe."},
}};

/// Letters, not bytes.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool is_language_code(std::string_view code) {
  return (code.size() == 2 || code.size() == 3) &&
         std::all_of(code.begin(), code.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

}  // namespace

std::string_view line_name(Line line) noexcept { return kSentences[static_cast<std::size_t>(line)].name; }

Words::Words() {
  for (const Sentence& sentence : kSentences) {
    const auto at = static_cast<std::size_t>(sentence.line);
    languages_["en"][at] = sentence.en;
    languages_["de"][at] = sentence.de;
    languages_["fr"][at] = sentence.fr;
  }
}

Result<Words> Words::parse(std::string_view json_text, std::string_view source) {
  DUBSAR_ASSIGN(const nlohmann::json object, parse_json(json_text, source));
  if (!object.is_object())
    return fail(ErrorKind::kConfig, "{}: no object of languages found, expected {{\"de\": {{\"grab\": \"...\"}}}}",
                source);
  Words out;
  for (const auto& [language, lines] : object.items()) {
    if (!is_language_code(language))
      return fail(ErrorKind::kConfig, "{}: \"{}\" is no language, expected a code such as de", source, language);
    if (!lines.is_object()) return fail(ErrorKind::kConfig, "{}: {} holds no object of lines", source, language);
    auto& own = out.languages_[language];
    for (const auto& [name, sentence] : lines.items()) {
      const auto found =
          std::find_if(kSentences.begin(), kSentences.end(),
                       [&, wanted = std::string_view(name)](const Sentence& s) { return s.name == wanted; });
      if (found == kSentences.end())
        return fail(ErrorKind::kConfig, "{}: {} has a line \"{}\", which does not exist", source, language, name);
      if (!sentence.is_string() || sentence.get_ref<const std::string&>().empty() ||
          letters(sentence.get_ref<const std::string&>()) > kLongestLine)
        return fail(ErrorKind::kConfig, "{}: {}.{} is no text of 1 to {} letters", source, language, name,
                    kLongestLine);
      own[static_cast<std::size_t>(found->line)] = sentence.get<std::string>();
    }
    if (std::string& tour = own[static_cast<std::size_t>(Line::kRestTour)]; tour.empty())
      tour = own[static_cast<std::size_t>(Line::kRest)];
    for (const Sentence& sentence : kSentences)
      if (own[static_cast<std::size_t>(sentence.line)].empty())
        return fail(ErrorKind::kConfig, "{}: {} is a new language and lacks the line \"{}\"", source, language,
                    sentence.name);
  }
  return out;
}

std::vector<std::string> Words::languages() const {
  std::vector<std::string> out;
  for (const auto& [language, lines] : languages_) out.push_back(language);
  return out;
}

bool Words::has(std::string_view language) const { return languages_.find(language) != languages_.end(); }

const std::string& Words::say(Line line, std::string_view language) const {
  const auto found = languages_.find(language);
  const auto& lines = found == languages_.end() ? languages_.find("en")->second : found->second;
  return lines[static_cast<std::size_t>(line)];
}

bool Words::right_to_left(std::string_view language) noexcept {
  constexpr std::array<std::string_view, 5> kRightToLeft{"ar", "ckb", "fa", "he", "ur"};
  return std::find(kRightToLeft.begin(), kRightToLeft.end(), language) != kRightToLeft.end();
}

}  // namespace dubsar::app
