#include "core/mesh_io/zip_writer.h"

#include <zlib.h>

#include <array>
#include <limits>
#include <string_view>

#include "core/base/numbers/bytes.h"

namespace dubsar {
namespace {

constexpr std::string_view kArchiveMaker =
    "made by dubsar";  // by which the program knows a file that it may write over

constexpr std::uint32_t kLocal = 0x04034b50, kDescriptor = 0x08074b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kDeflated = 8, kFlags = 1 << 11 | 1 << 3;  // names are UTF-8, sizes follow
constexpr std::uint16_t kNoDate = 0x21;                                           // the first of January 1980

Result<std::uint32_t> short_size(std::uint64_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::kUsage, "zip: {} bytes found, expected less than 4 GiB; take fewer parts, or PLY", size);
  return static_cast<std::uint32_t>(size);
}

}  // namespace

struct ZipWriter::Deflater {
  z_stream stream{};
  bool open = false;
  ~Deflater() {
    if (open) deflateEnd(&stream);
  }
};

ZipWriter::ZipWriter(AtomicFile& file) : file_(file), deflater_(std::make_unique<Deflater>()) {}
ZipWriter::~ZipWriter() = default;

/// Of an entry that has only begun: sum and sizes are 0, and stand behind the data.
std::string ZipWriter::local_header(const Entry& entry) const {
  std::string out;
  append_little(out, kLocal);
  for (const std::uint16_t field : {kVersion, kFlags, kDeflated, std::uint16_t{0}, kNoDate}) append_little(out, field);
  for (const std::uint64_t field : {std::uint64_t{entry.crc}, entry.packed, entry.bytes})
    append_little(out, static_cast<std::uint32_t>(field));
  append_little(out, static_cast<std::uint16_t>(entry.name.size()));
  append_little(out, std::uint16_t{0});
  return out + entry.name;
}

Result<void> ZipWriter::begin(std::string_view name) {
  Entry entry;
  entry.name = name;
  entry.offset = written_;
  entries_.push_back(entry);
  const std::string header = local_header(entry);
  written_ += header.size();
  if (deflateInit2(&deflater_->stream, 6, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return fail(ErrorKind::kTryAgain, "zip: no memory to compress");
  deflater_->open = true;
  return file_.write(header);
}

Result<void> ZipWriter::deflate(std::string_view bytes, bool last) {
  z_stream& stream = deflater_->stream;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::array<char, 65536> packed;
  do {
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    ::deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
    const std::size_t count = packed.size() - stream.avail_out;
    DUBSAR_TRY(file_.write(std::string_view(packed.data(), count)));
    entries_.back().packed += count;
    written_ += count;
  } while (stream.avail_out == 0);
  return {};
}

Result<void> ZipWriter::write(std::string_view bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
  while (!bytes.empty()) {
    const std::string_view piece = bytes.substr(0, kMost);
    Entry& entry = entries_.back();
    entry.crc = static_cast<std::uint32_t>(
        crc32(entry.crc, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size())));
    entry.bytes += piece.size();
    DUBSAR_TRY(deflate(piece, false));
    bytes.remove_prefix(piece.size());
  }
  return {};
}

Result<void> ZipWriter::end() {
  DUBSAR_TRY(deflate({}, true));
  deflateEnd(&deflater_->stream);
  deflater_->open = false;
  const Entry& entry = entries_.back();
  for (const std::uint64_t size : {entry.packed, entry.bytes, written_}) DUBSAR_TRY(short_size(size));
  std::string out;
  append_little(out, kDescriptor);
  for (const std::uint64_t field : {std::uint64_t{entry.crc}, entry.packed, entry.bytes})
    append_little(out, static_cast<std::uint32_t>(field));
  written_ += out.size();
  return file_.write(out);
}

Result<void> ZipWriter::finish() {
  std::string out;
  for (const Entry& entry : entries_) {
    append_little(out, kCentral);
    append_little(out, kVersion);
    const std::string local = local_header(entry);
    out += local.substr(4, 26);                                        // the same fields, from the version on
    for (int k = 0; k < 3; ++k) append_little(out, std::uint16_t{0});  // comment, disk, inner attributes
    append_little(out, std::uint32_t{0});
    append_little(out, static_cast<std::uint32_t>(entry.offset));
    out += entry.name;
  }
  DUBSAR_ASSIGN(const std::uint32_t at, short_size(written_));
  const auto size = static_cast<std::uint32_t>(out.size());
  const auto count = static_cast<std::uint16_t>(entries_.size());
  append_little(out, kEnd);
  for (const std::uint16_t field : {std::uint16_t{0}, std::uint16_t{0}, count, count}) append_little(out, field);
  append_little(out, size);
  append_little(out, at);
  append_little(out, static_cast<std::uint16_t>(kArchiveMaker.size()));  // the comment
  out += kArchiveMaker;
  return file_.write(out);
}

}  // namespace dubsar
