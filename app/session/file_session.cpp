#include "app/session/file_session.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <random>
#include <system_error>
#include <utility>

#include "app/document/join.h"
#include "app/words/text.h"
#include "core/base/files/file_fingerprint.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr TimestampNs kEveryNs = 5'000'000'000;  // half of what may be lost: writing takes its time, too
constexpr int kMostMeetings = 8;                 // of other windows, one after the other

std::string new_name() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

bool differ_in_looking_only(const Document& a, Document b) {
  b.now = a.now;
  return a == b;
}

std::string name_of(const fs::path& file) { return file.filename().string(); }

}  // namespace

FileSession::FileSession(SourceFile source, const fs::path& state_folder)
    : source_(std::move(source)), name_(new_name()) {
  const WorkPlaces places = places_of(source_, state_folder);
  places_ = {KeptFile(places.beside), KeptFile(places.state)};
  std::optional<Work> work;
  std::vector<OtherWork> others;
  const auto consider = [&](Work found, const fs::path& file, bool had_its_place) {
    const Belonging whose = belonging(found.document.source, source_, had_its_place);
    if (whose == Belonging::kThisSurface) {
      work = work ? join_copies(*work, found) : std::move(found);
    } else if (whose != Belonging::kNobody) {
      others.push_back({std::move(found), file.string(), whose == Belonging::kSameScan});
    }
    return whose == Belonging::kThisSurface;
  };
  std::array<Saves, 2> held;  // by the places
  for (std::size_t i = 0; i < places_.size(); ++i) {
    KeptFile& place = places_[i];
    if (place.path().empty()) continue;
    const auto text = place.read();
    auto found = !text   ? Result<Work>(tl::unexpect, text.error())
                 : *text ? parse_work(**text, place.path().string())
                         : Result<Work>(tl::unexpect, Error{ErrorKind::kNoInput, {}});
    if (text && !*text) continue;
    if (!found) told_.all.push_back(tr("work.left", found.error().message));
    if (found) held[i] = found->saves;
    if (found && consider(*std::move(found), place.path(), true)) continue;
    held[i] = {};
    place = KeptFile(place.path());  // what is there is not ours
  }
  for (const OtherPlace& other : other_places(source_, state_folder)) {
    const auto text = KeptFile(other.file).read();
    if (!text || !*text) continue;
    if (auto found = parse_work(**text, other.file.string()))
      consider(*std::move(found), other.file, other.had_its_place);
  }
  any_ = work.has_value();
  if (work) {
    saves_ = std::move(work->saves);
    for (std::size_t i = 0; i < places_.size(); ++i)
      behind_ = behind_ || (!places_[i].path().empty() && !held[i].contains(saves_));
    found_ = std::move(work->document);
    found_->source = source_;
  }
  const Document mine = found_.value_or(Document());
  for (OtherWork& other : others) {
    const bool known = any_ && saves_.contains(other.work.saves);
    const auto same = std::find_if(others_.begin(), others_.end(),
                                   [&](const OtherWork& each) { return each.work.saves.contains(other.work.saves); });
    if (same != others_.end()) same->copies.push_back(other.file);
    if (!known && same == others_.end() && !marks_more(mine, add_marks(mine, other.work.document)).empty())
      others_.push_back(std::move(other));
  }
}

fs::path FileSession::history_file() const {
  const fs::path& by_content = places_.back().path();
  return by_content.empty() ? fs::path() : by_content.parent_path() / "undo" / by_content.filename();
}

std::vector<std::string> FileSession::take_told() {
  std::vector<std::string> out(told_.all.begin() + static_cast<std::ptrdiff_t>(told_.said), told_.all.end());
  told_.said = told_.all.size();
  return out;
}

void FileSession::begin(const Document& first) { kept_ = {first, saves_}; }

Work FileSession::next(const Document& document) {
  for (const OtherWork& other : others_)  // whose notes were taken over: they are not offered again
    if (marks_more(document, add_marks(document, other.work.document)).empty()) saves_.join(other.work.saves);
  ++saves_.counts[name_];
  Work out{document, saves_};
  out.document.source = source_;
  return out;
}

/// What is there though it was not expected: work of this surface that `mine` did not follow from is given back; all
/// else is out of the way then.
Result<std::optional<Work>> FileSession::meet(Places& places, KeptFile& file, const Work& mine,
                                              std::vector<std::string>& told) {
  const auto text = file.read();
  if (text && !*text) return std::optional<Work>();  // it went meanwhile
  auto theirs = text ? parse_work(**text, file.path().string()) : Result<Work>(tl::unexpect, text.error());
  const SourceFile& source = mine.document.source;
  if (theirs && belonging(theirs->document.source, source, true) == Belonging::kThisSurface) {
    if (mine.saves.contains(theirs->saves) && !theirs->saves.contains(mine.saves)) return std::optional<Work>();
    return std::optional(*std::move(theirs));
  }
  if (theirs && &file == &places.front() && !places.back().path().empty())
    if (const auto content = file_checksum(source.path); !content || *content != source.content) {
      told.push_back(tr("work.anew", name_of(source.path), places.back().path().string()));
      file = KeptFile();  // its place is another surface's
      return std::optional<Work>();
    }
  DUBSAR_ASSIGN(const fs::path aside, file.set_aside());
  told.push_back(theirs ? tr("work.set_aside", name_of(aside))
                        : tr("work.broken_aside", theirs.error().message, name_of(aside)));
  return std::optional<Work>();
}

FileSession::Outcome FileSession::write(Places& places, const Work& work) {
  Outcome out;
  const std::string text = format_work(work);
  if (const auto read = parse_work(text, "what would be kept"); !read) {
    out.done = tl::unexpected<Error>(read.error());
    return out;
  }
  std::optional<Error> wrong;
  bool any = false;
  for (KeptFile& file : places) {
    if (file.path().empty()) continue;
    std::error_code ignored;
    if (&file != &places.front()) fs::create_directories(file.path().parent_path(), ignored);
    Result<Kept> done = Kept::kStranger;
    for (int i = 0; i < kMostMeetings && !file.path().empty(); ++i) {
      done = file.write(text);
      if (!done || *done == Kept::kDone) break;
      auto met = meet(places, file, work, out.told);
      if (!met) {
        done = tl::unexpected<Error>(met.error());
        break;
      }
      if (*met) {
        out.theirs = *std::move(met);
        return out;
      }
    }
    if (file.path().empty()) continue;
    if (done && *done == Kept::kDone)
      any = true;
    else if (!wrong)
      wrong = done ? Error{ErrorKind::kTryAgain, file.path().string() + " is changed by others all the time"}
                   : done.error();
  }
  out.behind = any && wrong && wrong->kind != ErrorKind::kPermission;
  if (out.behind) out.told.push_back(tr("work.one_place", wrong->message));
  if (wrong && !any) out.done = tl::unexpected<Error>(*std::move(wrong));
  return out;
}

/// What an attempt to write means for this window.
std::optional<Document> FileSession::take(Outcome outcome, const Document& document) {
  for (std::string& sentence : outcome.told)
    if (std::find(told_.all.begin(), told_.all.end(), sentence) == told_.all.end())
      told_.all.push_back(std::move(sentence));
  if (!outcome.looked) failed_.reset();
  if (outcome.theirs) {
    const Work& theirs = *outcome.theirs;
    const bool followed = theirs.saves.contains(kept_.saves);
    Document joined = join(followed ? &kept_.document : nullptr, document, theirs.document);
    saves_.join(theirs.saves);
    kept_ = theirs;
    kept_.document.source = source_;
    any_ = true;
    behind_ = true;  // the other place
    next_ = 0;
    const std::string more = marks_more(document, joined);
    if (!more.empty()) told_.all.push_back(tr("work.joined", more));
    return joined;
  }
  if (!outcome.done) {
    failed_ = outcome.done.error();
    return std::nullopt;
  }
  if (outcome.looked) return std::nullopt;
  kept_ = writing_work_;
  any_ = true;
  behind_ = outcome.behind;
  return std::nullopt;
}

bool FileSession::has_kept(const Document& document) const {
  if ((writing_.valid() && !looking_) || failed_ || behind_) return false;
  Document wanted = document;
  wanted.source = kept_.document.source;
  return wanted == kept_.document || (!any_ && differ_in_looking_only(wanted, kept_.document));
}

Result<std::optional<Document>> FileSession::keep(TimestampNs now, const Document& document) {
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::optional<Document>();
    if (auto joined = take(writing_.get(), document)) return joined;
    if (failed_) return tl::unexpected<Error>(*failed_);
  }
  if (now < next_) return std::optional<Document>();
  next_ = now + kEveryNs;
  const bool writes = !has_kept(document);
  looking_ = !writes;
  writing_work_ = writes ? next(document) : Work{document, saves_};
  writing_work_.document.source = source_;
  writing_ = std::async(std::launch::async, [this, writes] {
    try {
      return writes ? write(places_, writing_work_) : look_around(places_, writing_work_);
    } catch (const std::bad_alloc&) {
      return Outcome{fail(ErrorKind::kTryAgain, "there is not enough memory to keep the work"), {}, {}, false, false};
    }
  });
  return std::optional<Document>();
}

Result<Document> FileSession::leave(const Document& document) {
  Document now = document;
  if (writing_.valid())
    if (auto joined = take(writing_.get(), now)) now = *std::move(joined);
  for (int i = 0; i < kMostMeetings; ++i) {
    if (has_kept(now)) return now;
    writing_work_ = next(now);
    auto joined = take(write(places_, writing_work_), now);
    if (failed_) return tl::unexpected<Error>(*failed_);
    if (!joined) return now;
    now = *std::move(joined);
  }
  return fail(ErrorKind::kTryAgain, "{} is changed by other windows all the time", places_[0].path().string());
}

/// Work of this surface that `mine` did not follow from.
FileSession::Outcome FileSession::look_around(Places& places, const Work& mine) {
  Outcome out;
  out.looked = true;
  for (KeptFile& file : places) {
    if (file.path().empty() || file.is_known()) continue;
    KeptFile other(file.path());
    const auto text = other.read();
    if (!text || !*text) continue;
    auto theirs = parse_work(**text, file.path().string());
    const SourceFile& source = mine.document.source;
    if (!theirs || belonging(theirs->document.source, source, true) != Belonging::kThisSurface) continue;
    file = other;
    if (mine.saves.contains(theirs->saves)) continue;
    out.theirs = out.theirs ? join_copies(*out.theirs, *theirs) : *std::move(theirs);
  }
  return out;
}

std::optional<Document> FileSession::look(const Document& document) {
  wait();
  std::optional<Document> out;
  if (writing_.valid()) out = take(writing_.get(), document);
  const Document now = out.value_or(document);
  if (auto joined = take(look_around(places_, {now, saves_}), now)) out = std::move(joined);
  return out;
}

void FileSession::wait() const {
  if (writing_.valid()) writing_.wait();
}

}  // namespace dubsar::app
