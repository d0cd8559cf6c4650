// What in a file of ATF is against its grammar, and where.

#include <fmt/format.h>

#include <set>

#include "core/base/text/near_word.h"
#include "core/edition/atf.h"
#include "core/edition/brackets.h"
#include "core/edition/line_number.h"

namespace dubsar {
namespace {

constexpr std::string_view kAtfWords =
    "tablet, envelope, prism, bulla, fragment, object, obverse, reverse, left, right, top, bottom, edge, face, "
    "surface, "
    "column, seal, catchline, colophon, date, signatures, summary, witnesses";

bool is_text_id(std::string_view id) {
  return id.size() == 7 && std::string_view("PQXS").find(id[0]) != std::string_view::npos &&
         id.substr(1).find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_whole(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The first byte that belongs to no character of UTF-8, or controls a terminal; npos: there is none.
std::size_t foul_byte(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    std::size_t more = 0;
    if (byte >= 0xc2 && byte < 0xe0) more = 1;
    if (byte >= 0xe0 && byte < 0xf0) more = 2;
    if (byte >= 0xf0 && byte < 0xf5) more = 3;
    const bool alone = (byte >= 0x20 && byte < 0x7f) || byte == '\t' || (byte == '\r' && at + 1 == text.size());
    if (more == 0 && !alone) return at;
    for (std::size_t k = 1; k <= more; ++k)
      if (at + k >= text.size() || (static_cast<unsigned char>(text[at + k]) & 0xc0u) != 0x80u) return at;
    at += more + 1;
  }
  return std::string_view::npos;
}

class AtfCheck {
 public:
  std::vector<AtfFault> check(const AtfFile& file) {
    for (const AtfLine& line : file.lines) {
      ++number_;
      line_ = &line;
      look();
    }
    return std::move(faults_);
  }

 private:
  void say(std::size_t column, std::string message, bool only_warning = false) {
    faults_.push_back({number_, column, std::move(message), only_warning});
  }
  std::size_t column_of(std::string_view part) const {
    const std::size_t at = part.empty() ? std::string::npos : line_->bytes.rfind(part);
    return at == std::string::npos ? 1 : characters_before(line_->bytes, at) + 1;
  }

  void look() {
    if (const std::size_t at = foul_byte(line_->bytes); at != std::string_view::npos)
      say(characters_before(line_->bytes, at) + 1,
          fmt::format("byte {:02x} found, expected text in UTF-8", static_cast<unsigned char>(line_->bytes[at])));
    const AtfKind kind = line_->kind;
    if (!in_text_ && kind != AtfKind::kText && kind != AtfKind::kBlank && kind != AtfKind::kComment) {
      say(1, "this stands before any text; expected first a line such as \"&P123456 = AO 8295\"");
      in_text_ = true;  // said once
    }
    switch (kind) {
      case AtfKind::kText:
        return look_at_text();
      case AtfKind::kProtocol:
        return look_at_protocol();
      case AtfKind::kObject:
      case AtfKind::kSurface:
        return look_at_surface();
      case AtfKind::kColumn:
        if (!is_whole(line_->value))
          say(1, fmt::format("\"@column {}\" found, expected a number as in \"@column 2\"", line_->value));
        return begin_place();
      case AtfKind::kSeal:
        if (line_->value.empty()) say(1, "\"@seal\" found, expected a number as in \"@seal 1\"");
        return begin_place();
      case AtfKind::kState:
        return look_at_state();
      case AtfKind::kLine:
        return look_at_line();
      case AtfKind::kContinued:
      case AtfKind::kLink:
      case AtfKind::kBilingual:
      case AtfKind::kGloss:
      case AtfKind::kLemmas:
        if (!after_line_)
          say(1, fmt::format("a {} found where no numbered line stands above it", name_in(kAtfKinds, kind)));
        if (kind == AtfKind::kBilingual) look_at_brackets();
        return;
      case AtfKind::kTranslation:
        if (line_->key.empty() || line_->key.size() < 2)
          say(1, "\"#tr\" found, expected the language, as in \"#tr.en: \"", true);
        return;
      case AtfKind::kUnknown:
        return look_at_unknown();
      default:
        return;
    }
  }

  void look_at_text() {
    in_text_ = true;
    begun_ = after_line_ = false;
    begin_place();
    if (!is_text_id(line_->key))
      say(2, fmt::format("\"{}\" found, expected P, Q or X and six digits, as in \"&P123456 = AO 8295\"", line_->key));
    else if (line_->value.empty())
      say(1, fmt::format("\"&{}\" has no name, expected \"&{} = AO 8295\"", line_->key, line_->key));
  }

  void look_at_protocol() {
    if (line_->key == "project" && begun_)
      say(1, "\"#project:\" found below the text, expected it directly below its \"&\" line", true);
    if (line_->value.empty()) say(1, fmt::format("\"#{}:\" says nothing", line_->key), true);
  }

  void look_at_surface() {
    begun_ = true;
    begin_place();
    const bool wants =
        line_->key == "fragment" || line_->key == "object" || line_->key == "surface" || line_->key == "face";
    const bool takes = wants || line_->key == "edge";
    if (!takes && !line_->value.empty() && line_->kind == AtfKind::kSurface)
      say(column_of(line_->value),
          fmt::format("\"@{}\" is followed by \"{}\", expected nothing or one of ' ? ! *", line_->key, line_->value));
    if (wants && line_->value.empty()) say(1, fmt::format("\"@{}\" found, expected which one behind it", line_->key));
  }

  void look_at_state() {
    begun_ = true;
    if (atf_state_form(line_->value) == AtfStateForm::kWrong)
      say(column_of(line_->value),
          fmt::format("\"$ {}\" found, expected a state such as \"$ 3 lines broken\", \"$ rest of obverse missing\", "
                      "\"$ single ruling\", or free text in parentheses",
                      line_->value),
          true);
  }

  void look_at_line() {
    begun_ = after_line_ = true;
    if (!is_line_number(line_->key))
      say(1, fmt::format("line number \"{}\" found, expected 3, 3', 3a, a+3 or 3-4", line_->key), true);
    if (!numbers_.insert(line_->key).second) say(1, fmt::format("line {} stands twice on this side", line_->key), true);
    if (line_->value.empty())
      say(1, fmt::format("line {} is empty; expected \"x\", \"[...]\" or text", line_->key), true);
    look_at_brackets();
  }

  void look_at_brackets() {
    const std::string& text = line_->value;
    const std::size_t before = column_of(text) - 1;
    for (const BracketFault& fault : bracket_faults(text)) {
      constexpr const char* kWhat[] = {"is not closed in this line", "closes nothing", "stands within another one"};
      say(before + fault.column, fmt::format("{} {}", fault.bracket, kWhat[static_cast<int>(fault.kind)]),
          fault.kind == BracketFault::Kind::kNested);
    }
  }

  void look_at_unknown() {
    if (line_->bytes.starts_with("@")) {
      say(2, fmt::format("\"@{}\" found, expected @tablet, @obverse, @reverse, @column 1 or the like{}", line_->key,
                         did_you_mean(line_->key, kAtfWords)));
      return;
    }
    say(1, "this is no line of ATF; expected a number with a point as in \"1. a-na\", or one of & @ $ # in front");
  }

  void begin_place() {
    numbers_.clear();
    after_line_ = false;
  }

  std::vector<AtfFault> faults_;
  std::size_t number_ = 0;
  const AtfLine* line_ = nullptr;
  bool in_text_ = false;           ///< below an & line
  bool begun_ = false;             ///< below the protocols of a text
  bool after_line_ = false;        ///< a numbered line stands above, on this side
  std::set<std::string> numbers_;  ///< of lines on this side
};

}  // namespace

std::vector<AtfFault> check_atf(const AtfFile& file) { return AtfCheck().check(file); }

}  // namespace dubsar
