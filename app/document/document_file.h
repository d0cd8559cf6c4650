#pragma once
// Documents as JSON files: versioned, written whole or not at all.

#include <filesystem>
#include <string>
#include <string_view>

#include "app/document/document.h"
#include "app/document/saves.h"
#include "core/base/result.h"

namespace dubsar::app {

inline constexpr std::string_view kDocumentFormat = "dubsar document";
/// Of a file that is read; nothing larger is written.
inline constexpr std::size_t kLargestDocument = std::size_t{64} << 20;

/// A document as it is kept.
struct Work {
  Document document;
  Saves saves;
  friend bool operator==(const Work&, const Work&) = default;
};

/// Places in mm get three digits, all else is exact: format_work(parse_work(t)) is t for every text t that format_work
/// made. Notes and measures without an id get one, of what they are made of.
std::string format_work(const Work& work);
std::string format_document(const Document& document);

/// kBadData, in one sentence with what was found and expected, for text that is no document of this program, of a newer
/// version, or out of range. A text that does not tell its saves counts as one of its own kind: two of them that differ
/// do not follow from each other.
Result<Work> parse_work(std::string_view text, std::string_view source);
Result<Document> parse_document(std::string_view text, std::string_view source);

/// Errors of read_text_file() besides.
Result<Work> load_work(const std::filesystem::path& path);

/// Gives an id to notes and measures that have none, or that of another one: made of what they consist of, with a
/// number where that is taken.
void give_ids(Document& document);

}  // namespace dubsar::app
