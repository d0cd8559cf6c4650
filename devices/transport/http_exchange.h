#pragma once
// One HTTP request and its answer over a stream, as services on this machine need it: no redirects, no
// encryption.

#include <optional>
#include <string>
#include <string_view>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::size_t kMaxHttpBytes = std::size_t{1} << 20;  ///< of a whole answer

struct HttpReply {
  int status = 0;
  std::string body;
};

/// A PUT with a JSON body that asks the server to close the connection afterwards (RFC 9112).
std::string format_http_put(std::string_view host, std::string_view path, std::string_view json);

/// The answer, if `bytes` hold all of it; nothing when more has to come. `ended`: the server has closed,
/// nothing will come. Bodies by Content-Length, chunked, or up to the end. kBadData: not HTTP/1,
/// more than 8 interim answers (1xx), contradicting lengths, cut short, longer than kMaxHttpBytes.
Result<std::optional<HttpReply>> parse_http_reply(std::string_view bytes, bool ended);

/// Sends the request and reads until the answer is whole. kUnavailable: nothing whole within `time_limit` of
/// the clock. Blocks. Opens nothing: the stream is fresh and is used up.
Result<HttpReply> http_put(Transport& stream, std::string_view host, std::string_view path, std::string_view json,
                           const Clock& clock, TimestampNs time_limit);

}  // namespace dubsar
