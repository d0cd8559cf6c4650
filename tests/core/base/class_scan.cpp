#include "tests/core/base/class_scan.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace dubsar {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// The source without comments, literals and lines of the preprocessor; what is left keeps its order.
std::string bare_code(std::string_view source) {
  std::string code;
  bool line_begins = true;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const char c = source[i];
    const std::string_view rest = source.substr(i);
    if (line_begins && c == '#') {
      while (i < source.size() && (source[i] != '\n' || source[i - 1] == '\\')) ++i;
      code += '\n';
      continue;
    }
    if (c == '\n')
      line_begins = true;
    else if (std::isspace(static_cast<unsigned char>(c)) == 0)
      line_begins = false;
    if (rest.starts_with("//")) {
      i = std::min(source.find('\n', i), source.size()) - 1;
    } else if (rest.starts_with("/*")) {
      i = std::min(source.find("*/", i + 2), source.size() - 2) + 1;
    } else if (rest.starts_with("R\"") && (i == 0 || !is_word(source[i - 1]))) {
      const std::size_t open = source.find('(', i);
      const std::string end = ")" + std::string(source.substr(i + 2, open - i - 2)) + "\"";
      i = std::min(source.find(end, open), source.size() - end.size()) + end.size() - 1;
      code += '0';
    } else if (c == '"' || (c == '\'' && (i == 0 || !is_word(source[i - 1])))) {  // 1'000 is no character
      for (++i; i < source.size() && source[i] != c; ++i)
        if (source[i] == '\\') ++i;
      code += '0';
    } else if (c != '\'') {
      code += c;
    }
  }
  return code;
}

std::string trimmed(std::string text) {
  static const std::regex kAttributes(R"(\[\[[^\]]*\]\]|\balignas\s*\([^)]*\))");
  static const std::regex kAccess(R"(^\s*(public|private|protected)\s*:(?!:))");
  text = std::regex_replace(text, kAttributes, " ");
  while (std::regex_search(text, kAccess)) text = std::regex_replace(text, kAccess, "");
  const auto first = std::find_if_not(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; });
  return {first, text.end()};
}

// Walks over a declaration and calls at(c) for what stands outside of all brackets, template arguments included.
template <class At>
void outside_brackets(std::string_view text, At at) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const char before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
    const bool shift = (c == '<' && (after == '<' || before == '<')) || (c == '>' && before == '-');
    if (c == ')' || c == ']' || c == '}' || (c == '>' && depth > 0 && !shift)) --depth;
    if (depth == 0) at(i, c);
    if (c == '(' || c == '[' || c == '{' || (c == '<' && !shift)) ++depth;
  }
}

// Has the declaration a list of parameters, before any initial value?
bool is_function(std::string_view statement) {
  bool parameters = false, value = false;
  std::size_t open = 0;
  outside_brackets(statement, [&](std::size_t i, char c) {
    if (c == '=' || c == '{') value = true;
    if (c == '(' && !value && !parameters) parameters = true, open = i;
  });
  if (!parameters) return false;
  const std::size_t inside = statement.find_first_not_of(" \n", open + 1);
  return inside == std::string_view::npos || statement[inside] != '*';  // a pointer to a function is a member
}

int declared(const std::string& statement) {
  static const std::regex kNone(
      R"(\boperator\b|^(using|typedef|friend|static|constexpr static|inline static|static_assert|template|enum|operator|(class|struct|union)\s+\w+\s*;)\b|^\s*;|^DUBSAR_|^GLM_)");
  static const std::regex kForward(R"(^(class|struct|union|enum class|enum)\s+[\w:]+\s*;)");
  if (std::regex_search(statement, kNone) || std::regex_search(statement, kForward) || is_function(statement)) return 0;
  int count = 1;
  outside_brackets(statement, [&](std::size_t, char c) { count += c == ',' ? 1 : 0; });
  return count;
}

class Scanner {
 public:
  explicit Scanner(std::string code) : code_(std::move(code)) {}

  std::vector<ScannedClass> scan() {
    while (at_ < code_.size()) scope("", nullptr);
    return std::move(classes_);
  }

 private:
  // To the brace that closes this scope. `members` counts for the class it belongs to; null in namespaces.
  void scope(const std::string& outer, int* members) {
    std::string statement;
    for (; at_ < code_.size(); ++at_) {
      const char c = code_[at_];
      if (c == '}') {
        ++at_;
        return;
      }
      if (c == '(') {
        const std::size_t begin = at_;
        skip('(', ')');
        statement += code_.substr(begin, at_ - begin);
        --at_;
      } else if (c == ';') {
        if (members != nullptr) *members += declared(trimmed(statement + ";"));
        statement.clear();
      } else if (c == '{') {
        ++at_;
        statement = braces(outer, members, trimmed(statement));
        --at_;
      } else {
        statement += c;
      }
    }
  }

  // Behind an opening brace whose statement began with `head`; returns what of the statement goes on behind it.
  std::string braces(const std::string& outer, int* members, const std::string& head) {
    static const std::regex kScope(R"(^(?:(?:inline\s+)?namespace\b\s*([\w:]*)|extern\s+0)[^(]*$)");
    static const std::regex kEnum(R"(^enum\b(?:\s+class\b|\s+struct\b)?\s*(\w+)[^=(]*$)");
    static const std::regex kClass(
        R"(^(?:template\s*<[\s\S]*>\s*(?:requires[\s\S]*)?)?(?:typedef\s+)?(?:class|struct|union)\b\s*([\w:]*)[^=(]*$)");
    std::smatch match;
    if (std::regex_search(head, match, kScope)) {
      const std::string around = namespaces_, own = match[1].str().empty() ? "(unnamed)" : match[1].str();
      namespaces_ = around.empty() ? own : around + "::" + own;
      scope(outer, nullptr);
      namespaces_ = around;
      return "";
    }
    if (std::regex_search(head, match, kEnum))
      classes_.push_back({outer.empty() ? match[1].str() : outer + "::" + match[1].str(), 0, namespaces_, true});
    if (std::regex_search(head, match, kClass)) {
      const std::string own = match[1].str().empty() ? "(unnamed)" : match[1].str();
      const std::string name = outer.empty() ? own : outer + "::" + own;
      int count = 0;
      scope(name, &count);
      classes_.push_back({name, count, namespaces_});
      const bool more =
          code_.find_first_not_of(" \n", at_) < code_.size() && code_[code_.find_first_not_of(" \n", at_)] != ';';
      if (own == "(unnamed)" && members != nullptr) *members += more ? std::max(0, count - 1) : count;
      return more ? "type " : "using ";  // "struct { } name;" declares, "struct Name { };" does not
    }
    const bool function = is_function(head);
    --at_;
    skip('{', '}');
    const std::size_t next = std::min(code_.find_first_not_of(" \n", at_), code_.size() - 1);
    if (function && code_[next] != ',' && code_[next] != '{' && code_[next] != ';') return "";
    return head + "{}";  // an initial value, or one of a constructor's list
  }

  void skip(char open, char close) {
    int depth = 0;
    for (; at_ < code_.size(); ++at_) {
      if (code_[at_] == open) ++depth;
      if (code_[at_] == close && --depth == 0) break;
    }
    ++at_;
  }

  std::string code_;
  std::size_t at_ = 0;
  std::string namespaces_;  // around at_
  std::vector<ScannedClass> classes_;
};

}  // namespace

std::vector<ScannedClass> scan_classes(std::string_view source) { return Scanner(bare_code(source)).scan(); }

}  // namespace dubsar
