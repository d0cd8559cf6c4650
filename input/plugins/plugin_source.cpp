// A plug-in as a source: its thread may be left behind, so everything that it touches is shared with it.

#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "core/base/system/log.h"
#include "core/base/text/option_reader.h"
#include "devices/transport/retry_pause.h"
#include "input/event_limit.h"
#include "input/plugins/plugin_frame.h"
#include "input/plugins/source_plugin.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kReadTimeoutMs = 20;
constexpr TimestampNs kStaleNs = 300'000'000;
constexpr std::chrono::microseconds kShortestTurn{500};  // a plug-in that floods is read 2000 times a second
using ErrorText = std::array<char, 512>;

std::string sentence(ErrorText& text) {
  text.back() = '\0';
  return text.front() != '\0' ? text.data() : "no reason given";
}

/// Calls into the plug-in; what it throws becomes `failed` with the reason in `error`.
template <class Call, class T>
T guarded(const Call& call, T failed, std::string& error) noexcept {
  try {
    ErrorText text{};
    const T result = call(text);
    if (result == failed) error = sentence(text);
    return result;
  } catch (const std::exception& thrown) {
    error = std::string("it threw an exception: ") + thrown.what();
  } catch (...) {
    error = "it threw an exception";
  }
  return failed;
}

/// One plug-in's source with what it has said so far.
class PluginRunner {
 public:
  PluginRunner(std::shared_ptr<SourcePlugin> plugin, void* source, const Pose& place)
      : plugin_(std::move(plugin)), source_(source), collected_(place) {}
  /// After the last turn, in the thread that ends the source, or in its own when it was left behind.
  ~PluginRunner() {
    std::string ignored;
    if (open_) guarded([&](ErrorText&) { return plugin_->table().close(source_), 0; }, 1, ignored);
    guarded([&](ErrorText&) { return plugin_->table().destroy(source_), 0; }, 1, ignored);
  }
  PluginRunner(const PluginRunner&) = delete;
  PluginRunner& operator=(const PluginRunner&) = delete;

  /// Opens or reads once. False: nothing is open.
  bool turn(TimestampNs now, std::uint32_t timeout_ms) {
    const dubsar_source_table& table = plugin_->table();
    std::string why;
    if (!open_) {
      if (!retry_.due(now)) return false;
      if (guarded([&](ErrorText& e) { return table.open(source_, e.data(), e.size()) == 0 ? 0 : 1; }, 1, why) != 0) {
        retry_.failed(now);
        say_lost(why);
        return false;
      }
      retry_.succeeded();
      open_ = true;
      const std::lock_guard lock(mutex_);
      connected_ = true;
      answered_ = now;
    }
    collected_.begin(now);
    const dubsar_source_sink sink = collected_.sink();
    const int got = guarded(
        [&](ErrorText& e) {
          const int result = table.read(source_, timeout_ms, &sink, e.data(), e.size());
          return result < 0 ? static_cast<int>(DUBSAR_SOURCE_LOST) : result;
        },
        static_cast<int>(DUBSAR_SOURCE_LOST), why);
    if (got == DUBSAR_SOURCE_LOST) {
      open_ = false;
      std::string ignored;
      guarded([&](ErrorText&) { return table.close(source_), 0; }, 1, ignored);
      retry_.lost(now);
      say_lost(why);
      return false;
    }
    const std::lock_guard lock(mutex_);
    answered_ = now;
    if (got != DUBSAR_SOURCE_NEW) return true;
    collected_.finish(frame_);
    if (frame_.events.size() > kMostEvents) frame_.events.resize(kMostEvents);
    if (collected_.dropped() > 0) note_ = "it says more at once than anybody needs; what is too much is dropped";
    if (collected_.refused() > 0) note_ = "it says things that cannot be: numbers that are none, or places 100 m away";
    fresh_ = true;
    return true;
  }

  Freshness poll(TimestampNs now, InputFrame& newest) {
    newest.events.clear();
    const std::lock_guard lock(mutex_);
    silent_ = connected_ && now - answered_ > kPluginPatienceNs;
    if (!connected_ || silent_) newest.space_mouse.reset();
    const bool fresh = std::exchange(fresh_, false);
    if (fresh) {
      newest.time = frame_.time;
      newest.heads = frame_.heads;
      newest.hands = frame_.hands;
      newest.space_mouse = frame_.space_mouse;
      newest.events.swap(frame_.events);
      frame_.events.clear();
    }
    if (now - newest.time > kStaleNs) {
      newest.heads.clear();
      newest.hands.clear();
    }
    if (!connected_ || silent_) return Freshness::kLost;
    return fresh ? Freshness::kNew : Freshness::kUnchanged;
  }
  std::string note() const {
    const std::lock_guard lock(mutex_);
    if (!connected_) return plugin_->name() + ": " + (reason_.empty() ? "not opened yet" : reason_);
    if (silent_) return plugin_->name() + ": its plug-in has not answered for more than 2 s";
    return note_.empty() ? std::string() : plugin_->name() + ": " + note_;
  }
  const SourcePlugin& plugin() const noexcept { return *plugin_; }

 private:
  void say_lost(const std::string& why) {
    const std::lock_guard lock(mutex_);
    connected_ = fresh_ = false;
    frame_.space_mouse.reset();
    reason_ = why;
  }

  // Of the thread that reads.
  const std::shared_ptr<SourcePlugin> plugin_;
  void* const source_;
  PluginFrame collected_;
  RetryPause retry_;
  bool open_ = false;

  mutable std::mutex mutex_;
  InputFrame frame_;                                         // guarded by mutex_
  std::string reason_, note_;                                // guarded by mutex_
  TimestampNs answered_ = 0;                                 // guarded by mutex_
  bool connected_ = false, fresh_ = false, silent_ = false;  // guarded by mutex_
};

/// Begins and ends the thread of a runner. What the thread needs it owns together with the source.
class PluginSource final : public InputSource {
 public:
  PluginSource(std::shared_ptr<PluginRunner> runner, const InputConfig& config)
      : name_("plugin:" + runner->plugin().name()), threaded_(!config.simulated_time), runner_(std::move(runner)) {}

  ~PluginSource() override {
    if (!thread_.joinable()) return;
    std::unique_lock lock(life_->mutex);
    life_->stopping = true;
    life_->changed.notify_all();
    const bool ended =
        life_->changed.wait_for(lock, std::chrono::nanoseconds(kPluginPatienceNs), [this] { return life_->ended; });
    lock.unlock();
    if (ended) {
      thread_.join();
      return;
    }
    log_warning("{}: its plug-in does not come back; it is left behind", name_);
    thread_.detach();
  }

  std::string_view name() const noexcept override { return name_; }
  Result<void> start() override {
    if (!threaded_ || thread_.joinable()) return {};
    thread_ = std::thread([life = life_, runner = runner_]() mutable {
      const SteadyClock clock;
      while (!life->over()) {
        const auto begun = std::chrono::steady_clock::now();
        const bool open = runner->turn(clock.now(), kReadTimeoutMs);
        life->pause_until(begun + (open ? std::chrono::steady_clock::duration(kShortestTurn)
                                        : std::chrono::steady_clock::duration(std::chrono::milliseconds(2))));
      }
      runner.reset();
      const std::lock_guard lock(life->mutex);
      life->ended = true;
      life->changed.notify_all();
    });
    return {};
  }
  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    if (!threaded_) runner_->turn(now, 0);
    return runner_->poll(now, newest);
  }
  std::string note() const override { return runner_->note(); }

 private:
  struct Life {
    std::mutex mutex;
    std::condition_variable changed;
    bool stopping = false, ended = false;
    bool over() {
      const std::lock_guard lock(mutex);
      return stopping;
    }
    void pause_until(std::chrono::steady_clock::time_point when) {
      std::unique_lock lock(mutex);
      changed.wait_until(lock, when, [this] { return stopping; });
    }
  };
  const std::string name_;
  const bool threaded_;
  std::shared_ptr<PluginRunner> runner_;
  std::shared_ptr<Life> life_ = std::make_shared<Life>();
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<InputSource>> make_plugin_source(const InputConfig& config) {
  OptionReader options(config.options, "input plugin");
  const std::string file = options.first_word();
  if (file.empty())
    return fail(ErrorKind::kUsage, "input plugin: expected a file, as plugin:FILE.so[,at=X/Y/Z,turn=X/Y/Z,...]");
  DUBSAR_ASSIGN(std::shared_ptr<SourcePlugin> plugin, SourcePlugin::load(file));
  const Pose place = options.placement(Pose{});
  DUBSAR_TRY(options.status());
  const std::string rest = options_text(options.take_rest());
  std::string why;
  void* const source = guarded([&](ErrorText& e) { return plugin->table().create(rest.c_str(), e.data(), e.size()); },
                               static_cast<void*>(nullptr), why);
  if (source == nullptr) return fail(ErrorKind::kUsage, "input plugin {}: {}", plugin->name(), why);
  auto made = std::make_unique<PluginSource>(std::make_shared<PluginRunner>(plugin, source, place), config);
  DUBSAR_TRY(made->start());
  return made;
}

}  // namespace dubsar
