#include "devices/transport/http_exchange.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/text/lower_text.h"

namespace dubsar {
namespace {

constexpr std::string_view kLineEnd = "\r\n", kHeadEnd = "\r\n\r\n";
constexpr std::size_t kMaxHeadBytes = 16 << 10;
constexpr milliseconds kReadPiece{50};
constexpr int kMostInterim = 8;
constexpr int kMaxSilentReads = 1000;  // ends also when the clock stands still

bool same_word(std::string_view a, std::string_view b) { return lower_text(a) == lower_text(b); }

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// A whole field that is a number below kMaxHttpBytes.
std::optional<std::size_t> parse_size(std::string_view text, int base) noexcept {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value > kMaxHttpBytes)
    return std::nullopt;
  return value;
}

struct Head {
  int status = 0;
  bool chunked = false;
  std::optional<std::size_t> length;
};

Result<Head> parse_head(std::string_view text) {
  Head head;
  const std::string_view first = text.substr(0, text.find(kLineEnd));
  // "HTTP/1.1 200 OK"; the reason may be missing
  if (first.size() < 12 || !first.starts_with("HTTP/1.") || first[8] != ' ' || (first.size() > 12 && first[12] != ' '))
    return fail(ErrorKind::kBadData, "http: the answer does not start like one of HTTP/1");
  const auto status = parse_size(first.substr(9, 3), 10);
  if (!status || *status < 100) return fail(ErrorKind::kBadData, "http: the answer has no status between 100 and 999");
  head.status = static_cast<int>(*status);
  for (std::size_t at = first.size() + 2; at < text.size();) {
    const std::size_t end = std::min(text.find(kLineEnd, at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + kLineEnd.size();
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return fail(ErrorKind::kBadData, "http: a header line without a colon");
    const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
    if (same_word(name, "transfer-encoding")) {
      if (!same_word(value, "chunked"))
        return fail(ErrorKind::kBadData, "http: transfer encoding found that is not chunked");
      head.chunked = true;
    } else if (same_word(name, "content-length")) {
      const auto length = parse_size(value, 10);
      if (!length || (head.length && *head.length != *length))
        return fail(ErrorKind::kBadData, "http: content length found that is not one number up to {}", kMaxHttpBytes);
      head.length = length;
    }
  }
  if (head.chunked && head.length) return fail(ErrorKind::kBadData, "http: both a length and chunks are announced");
  return head;
}

/// The body that the chunks hold, or nothing when the last one is not there yet.
Result<std::optional<std::string>> parse_chunks(std::string_view text) {
  std::string body;
  while (true) {
    const std::size_t end = text.find(kLineEnd);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text.substr(0, end);
    const auto length = parse_size(trimmed(line.substr(0, line.find(';'))), 16);
    if (!length) return fail(ErrorKind::kBadData, "http: a chunk without a length");
    text.remove_prefix(end + kLineEnd.size());
    if (*length == 0) {  // trailers end with an empty line
      if (text.starts_with(kLineEnd) || text.find(kHeadEnd) != std::string_view::npos) return body;
      return std::nullopt;
    }
    if (text.size() < *length + kLineEnd.size()) return std::nullopt;
    if (text.substr(*length, kLineEnd.size()) != kLineEnd)
      return fail(ErrorKind::kBadData, "http: a chunk longer than it says");
    body += text.substr(0, *length);
    text.remove_prefix(*length + kLineEnd.size());
  }
}

}  // namespace

std::string format_http_put(std::string_view host, std::string_view path, std::string_view json) {
  return fmt::format(
      "PUT /{} HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: "
      "close\r\n\r\n{}",
      path, host, json.size(), json);
}

Result<std::optional<HttpReply>> parse_http_reply(std::string_view bytes, bool ended) {
  if (bytes.size() > kMaxHttpBytes)
    return fail(ErrorKind::kBadData, "http: an answer of more than {} bytes", kMaxHttpBytes);
  // 100 Continue and the like come before the answer
  for (int interim = 0; interim <= kMostInterim; ++interim) {
    const std::size_t end = bytes.find(kHeadEnd);
    if (end == std::string_view::npos) break;
    DUBSAR_ASSIGN(const Head head, parse_head(bytes.substr(0, end)));
    if (head.status >= 200) break;
    if (interim == kMostInterim)
      return fail(ErrorKind::kBadData, "http: more than {} answers of the kind 1xx before the one that counts",
                  kMostInterim);
    bytes.remove_prefix(end + kHeadEnd.size());
  }
  const auto not_whole = [&]() -> Result<std::optional<HttpReply>> {
    if (ended)
      return fail(ErrorKind::kBadData, "http: the answer ends after {} bytes, before it is whole", bytes.size());
    return std::nullopt;
  };
  const std::size_t head_end = bytes.find(kHeadEnd);
  if (head_end == std::string_view::npos) {
    if (bytes.size() > kMaxHeadBytes)
      return fail(ErrorKind::kBadData, "http: headers of more than {} bytes", kMaxHeadBytes);
    return not_whole();
  }
  DUBSAR_ASSIGN(const Head head, parse_head(bytes.substr(0, head_end)));
  const std::string_view rest = bytes.substr(head_end + kHeadEnd.size());
  if (head.chunked) {
    DUBSAR_ASSIGN(auto body, parse_chunks(rest));
    if (!body) return not_whole();
    return HttpReply{head.status, std::move(*body)};
  }
  if (head.length) {
    if (rest.size() < *head.length) return not_whole();
    return HttpReply{head.status, std::string(rest.substr(0, *head.length))};
  }
  if (!ended) return std::nullopt;
  return HttpReply{head.status, std::string(rest)};
}

Result<HttpReply> http_put(Transport& stream, std::string_view host, std::string_view path, std::string_view json,
                           const Clock& clock, TimestampNs time_limit) {
  const TimestampNs deadline = clock.now() + time_limit;
  const std::string request = format_http_put(host, path, json);
  DUBSAR_TRY(stream.write(std::as_bytes(std::span(request.data(), request.size()))));
  std::string received;
  std::array<std::byte, 4096> piece;
  for (int silent = 0; silent < kMaxSilentReads && clock.now() < deadline;) {
    const auto length = stream.read(piece, kReadPiece);
    const bool ended = !length;
    if (ended && length.error().kind != ErrorKind::kUnavailable) return tl::unexpected<Error>(length.error());
    if (!ended && *length == 0) {
      ++silent;
      continue;
    }
    if (!ended)
      for (const std::byte b : std::span(piece).first(*length))
        received += static_cast<char>(std::to_integer<unsigned char>(b));
    DUBSAR_ASSIGN(auto reply, parse_http_reply(received, ended));
    if (reply) return *std::move(reply);
  }
  return fail(ErrorKind::kUnavailable, "http: no whole answer to {} within {} ms", path, time_limit / 1'000'000);
}

}  // namespace dubsar
