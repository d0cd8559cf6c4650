#include "core/mesh_io/ply_header.h"

#include <array>
#include <optional>

#include "core/mesh_io/text_scanner.h"

namespace dubsar {
namespace {
constexpr std::size_t kMaxElements = 64, kMaxProperties = 1024, kMaxHeaderBytes = std::size_t{16} << 20;

std::optional<PlyScalar> scalar_of(std::string_view word) {
  struct Name {
    std::string_view name;
    PlyScalar type;
  };
  static constexpr std::array<Name, 16> kNames{{{"char", PlyScalar::kI8},
                                                {"int8", PlyScalar::kI8},
                                                {"uchar", PlyScalar::kU8},
                                                {"uint8", PlyScalar::kU8},
                                                {"short", PlyScalar::kI16},
                                                {"int16", PlyScalar::kI16},
                                                {"ushort", PlyScalar::kU16},
                                                {"uint16", PlyScalar::kU16},
                                                {"int", PlyScalar::kI32},
                                                {"int32", PlyScalar::kI32},
                                                {"uint", PlyScalar::kU32},
                                                {"uint32", PlyScalar::kU32},
                                                {"float", PlyScalar::kF32},
                                                {"float32", PlyScalar::kF32},
                                                {"double", PlyScalar::kF64},
                                                {"float64", PlyScalar::kF64}}};
  for (const Name& entry : kNames)
    if (entry.name == word) return entry.type;
  return std::nullopt;
}

std::string shown(std::string_view line) { return std::string(line.substr(0, 60)); }

Result<PlyProperty> parse_property(TextScanner& words, std::string_view line) {
  PlyProperty property;
  std::string_view word = words.word();
  if (word == "list") {
    property.list = true;
    const auto count_type = scalar_of(words.word());
    if (!count_type || !ply_is_integer(*count_type))
      return fail(ErrorKind::kBadData, "ply: \"{}\" found, expected an integer type for the list length", shown(line));
    property.count_type = *count_type;
    word = words.word();
  }
  const auto type = scalar_of(word);
  property.name = words.word();
  if (!type || property.name.empty())
    return fail(ErrorKind::kBadData, "ply: \"{}\" found, expected \"property TYPE NAME\"", shown(line));
  property.type = *type;
  return property;
}
}  // namespace

std::size_t ply_scalar_bytes(PlyScalar type) noexcept {
  constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

Result<PlyHeader> parse_ply_header(std::string_view bytes) {
  // Where lines end in CR alone, an LF behind the last one is the first byte of the data.
  const bool cr_alone = bytes.size() > 4 && bytes[3] == '\r' && bytes[4] != '\n';
  TextScanner lines(bytes.substr(0, kMaxHeaderBytes));
  if (lines.line() != "ply") return fail(ErrorKind::kBadData, "ply: the file does not start with \"ply\"");
  PlyHeader header;
  bool has_format = false;
  std::size_t properties = 0;
  while (!lines.rest().empty()) {
    const std::string_view line = lines.line();
    TextScanner words(line);
    const std::string_view key = words.word();
    if (key == "end_header") {
      if (!has_format) return fail(ErrorKind::kBadData, "ply: no format line in the header");
      header.body = static_cast<std::size_t>(line.data() - bytes.data()) + line.size() + 1;
      if (!cr_alone) header.body = static_cast<std::size_t>(lines.rest().data() - bytes.data());
      return header;
    }
    if (key == "format") {
      const std::string_view name = words.word();
      const std::string_view version = words.word();
      has_format = version == "1.0";
      if (name == "ascii")
        header.encoding = PlyEncoding::kAscii;
      else if (name == "binary_little_endian")
        header.encoding = PlyEncoding::kLittle;
      else if (name == "binary_big_endian")
        header.encoding = PlyEncoding::kBig;
      else
        has_format = false;
      if (!has_format)
        return fail(ErrorKind::kBadData,
                    "ply: \"{}\" found, expected format ascii, binary_little_endian or binary_big_endian 1.0",
                    shown(line));
    } else if (key == "element") {
      PlyElement element;
      element.name = words.word();
      if (element.name.empty() || !words.number(element.count))
        return fail(ErrorKind::kBadData, "ply: \"{}\" found, expected \"element NAME COUNT\"", shown(line));
      header.elements.push_back(std::move(element));
      if (header.elements.size() > kMaxElements)
        return fail(ErrorKind::kBadData, "ply: more than {} elements", kMaxElements);
    } else if (key == "property") {
      if (header.elements.empty()) return fail(ErrorKind::kBadData, "ply: a property stands before any element");
      DUBSAR_ASSIGN(PlyProperty property, parse_property(words, line));
      header.elements.back().properties.push_back(std::move(property));
      if (++properties > kMaxProperties)
        return fail(ErrorKind::kBadData, "ply: more than {} properties", kMaxProperties);
    } else if (key == "comment" || key == "obj_info") {
      header.text.line(line.size() > key.size() ? line.substr(key.size() + 1) : std::string_view());
    } else if (!key.empty()) {
      return fail(ErrorKind::kBadData, "ply: unknown header line \"{}\"", shown(line));
    }
  }
  return fail(ErrorKind::kBadData, "ply: the header does not end, expected \"end_header\"");
}

}  // namespace dubsar
