#include "devices/looking_glass/calibration_pages.h"

#include <algorithm>
#include <vector>

namespace dubsar {
namespace {

constexpr std::size_t kPageHeaderBytes = 4;
constexpr std::size_t kLengthBytes = 4;
constexpr milliseconds kReadTimeout{30};
constexpr int kReadsPerRequest = 64;         // then the page is asked for again
constexpr int kMaxReadsWithoutClock = 8192;  // ends also when the clock stands still

/// Puts 64 + 4 byte pieces together; a piece of 68 stands for itself.
class Reports {
 public:
  explicit Reports(Transport& transport) : transport_(&transport) {}

  struct Piece {
    bool silent = false;  ///< nothing came in time
    std::optional<LookingGlassPage> page;
  };

  Result<Piece> next() {
    std::array<std::byte, kLookingGlassReportBytes + 1> piece;
    DUBSAR_ASSIGN(const std::size_t length, transport_->read(piece, kReadTimeout));
    return Piece{length == 0, add(std::span<const std::byte>(piece).first(length))};
  }

 private:
  std::optional<LookingGlassPage> add(std::span<const std::byte> bytes) {
    if (bytes.size() == kLookingGlassReportBytes) {
      first_.clear();
      return parse_looking_glass(bytes);
    }
    if (bytes.size() == kLookingGlassPageBytes) {
      first_.assign(bytes.begin(), bytes.end());
    } else if (bytes.size() == kPageHeaderBytes && first_.size() == kLookingGlassPageBytes) {
      first_.insert(first_.end(), bytes.begin(), bytes.end());
      const auto page = parse_looking_glass(first_);
      first_.clear();
      return page;
    }
    return std::nullopt;
  }

  Transport* transport_;
  std::vector<std::byte> first_;
};

class PageReader {
 public:
  PageReader(Transport& transport, const Clock& clock, TimestampNs time_limit)
      : transport_(&transport), reports_(transport), clock_(&clock), deadline_(clock.now() + time_limit) {}

  Result<LookingGlassPage> page(std::uint16_t number) {
    while (true) {
      DUBSAR_TRY(transport_->set_feature(looking_glass_request(number)));
      for (int i = 0; i < kReadsPerRequest; ++i) {
        if (clock_->now() >= deadline_ || ++reads_ > kMaxReadsWithoutClock)
          return fail(ErrorKind::kUnavailable, "looking glass: no answer to the request of calibration page {}",
                      number);
        DUBSAR_ASSIGN(const auto piece, reports_.next());
        if (piece.page && piece.page->number == number) return *piece.page;
        if (piece.silent) break;
      }
    }
  }

 private:
  Transport* transport_;
  Reports reports_;
  const Clock* clock_;
  TimestampNs deadline_;
  int reads_ = 0;
};

}  // namespace

std::array<std::byte, kLookingGlassReportBytes> looking_glass_request(std::uint16_t page) noexcept {
  std::array<std::byte, kLookingGlassReportBytes> request{};
  request[2] = static_cast<std::byte>(page >> 8);
  request[3] = static_cast<std::byte>(page & 0xFFU);
  return request;
}

std::optional<LookingGlassPage> parse_looking_glass(std::span<const std::byte> report) noexcept {
  if (report.size() != kLookingGlassReportBytes || report[1] != std::byte{0}) return std::nullopt;
  LookingGlassPage page;
  page.buttons = std::to_integer<std::uint8_t>(report[0]);
  page.number =
      static_cast<std::uint16_t>(std::to_integer<unsigned>(report[2]) << 8 | std::to_integer<unsigned>(report[3]));
  std::copy(report.begin() + kPageHeaderBytes, report.end(), page.data.begin());
  return page;
}

std::array<std::byte, kLookingGlassReportBytes> format_looking_glass(const LookingGlassPage& page) noexcept {
  std::array<std::byte, kLookingGlassReportBytes> report = looking_glass_request(page.number);
  report[0] = static_cast<std::byte>(page.buttons);
  std::copy(page.data.begin(), page.data.end(), report.begin() + kPageHeaderBytes);
  return report;
}

Result<std::string> read_looking_glass_calibration(Transport& transport, const Clock& clock, TimestampNs time_limit) {
  PageReader reader(transport, clock, time_limit);
  DUBSAR_ASSIGN(LookingGlassPage page, reader.page(0));
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) length = length << 8 | std::to_integer<std::uint32_t>(page.data[i]);
  if (length == 0 || length == 0xFFFFFFFFU)
    return fail(ErrorKind::kBadData, "looking glass: the display's calibration memory is blank; use a profile by name");
  if (length > kLookingGlassMaxJsonBytes)
    return fail(ErrorKind::kBadData, "looking glass: calibration of {} bytes announced, expected at most {}", length,
                kLookingGlassMaxJsonBytes);
  std::string json;
  std::size_t from = kLengthBytes;
  for (std::uint16_t number = 1;; ++number) {
    for (; from < kLookingGlassPageBytes && json.size() < length; ++from)
      json += static_cast<char>(std::to_integer<unsigned char>(page.data[from]));
    if (json.size() == length) return json;
    from = 0;
    DUBSAR_ASSIGN(page, reader.page(number));
  }
}

}  // namespace dubsar
