#pragma once
// Windows on surfaces without windows: sessions on real files, in memory where there is room.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>

#include "app/document/join.h"
#include "app/session/file_session.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"

namespace dubsar::app {

inline std::set<std::string> note_texts(const Document& document) {
  std::set<std::string> out;
  for (const Note& note : document.notes) out.insert(note.text);
  return out;
}

/// Folders of their own for one test.
class WorkFolder {
 public:
  WorkFolder() {
    const std::filesystem::path memory("/dev/shm");
    const bool fast = ::access(memory.c_str(), W_OK) == 0;
    path = (fast ? memory : std::filesystem::temp_directory_path()) /
           fmt::format("dubsar_work_{}_{}", ::getpid(), ::testing::UnitTest::GetInstance()->random_seed());
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path / "tablets");
  }
  ~WorkFolder() { std::filesystem::remove_all(path); }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::filesystem::path tablet(const std::string& name) const { return path / "tablets" / name; }
  std::filesystem::path state() const { return path / "state" / "sessions"; }
  std::filesystem::path path;
};

inline SourceFile source_of(const std::filesystem::path& surface, const std::string& scan = {}) {
  SourceFile out{surface.string(), static_cast<std::int64_t>(std::filesystem::file_size(surface))};
  out.content = file_checksum(surface).value();
  out.scan = scan;
  return out;
}

/// One window on one surface.
struct WorkWindow {
  WorkWindow(const std::filesystem::path& surface, const std::filesystem::path& state, const std::string& scan = {})
      : session(std::make_unique<FileSession>(source_of(surface, scan), state)) {
    if (session->found()) document = *session->found();
    document.source = session->source();
    if (document.parts.empty()) document.parts = {{"tablet", 1}};
    session->begin(document);
  }
  void note(const std::string& text, double x = 0.0) {
    Note note;
    note.text = text;
    note.at_mm = {x, static_cast<double>(document.notes.size()), 1.0};
    document.notes.push_back(std::move(note));
    give_ids(document);
  }
  void erase(const std::string& text) {
    std::erase_if(document.notes, [&](const Note& note) { return note.text == text; });
  }
  Note& the(const std::string& text) {
    for (Note& note : document.notes)
      if (note.text == text) return note;
    ADD_FAILURE() << "no note " << text;
    return document.notes.emplace_back();
  }
  /// As the loop does it: after a while something is written.
  bool keep() {
    for (int i = 0; i < 8; ++i) {  // a turn begins to write or to look, the next one takes what came of it
      auto kept = session->keep(now += 6'000'000'000, document);
      if (!kept) return false;
      if (*kept) document = **std::move(kept);
      session->wait();
      if (i >= 2 && session->has_kept(document)) return true;
    }
    return session->has_kept(document);
  }
  bool leave() {
    auto kept = session->leave(document);
    if (kept) document = *std::move(kept);
    return kept.has_value();
  }
  void take_over() {
    for (const OtherWork& other : session->others()) document = add_marks(document, other.work.document);
  }
  std::set<std::string> texts() const { return note_texts(document); }

  std::unique_ptr<FileSession> session;
  Document document;
  TimestampNs now = 0;
};

}  // namespace dubsar::app
