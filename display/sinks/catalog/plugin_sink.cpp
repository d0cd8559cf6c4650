#include "display/sinks/catalog/plugin_sink.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "core/base/system/log.h"
#include "display/render/view_array.h"
#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar {
namespace {

constexpr int kMaxSide = 16384, kMaxViews = 2048;
using ErrorText = std::array<char, 512>;

std::string sentence(ErrorText& text) {
  text.back() = '\0';
  return text.front() != '\0' ? text.data() : "no reason given";
}

dubsar_sink_screen abi_screen(const Screen& s) {
  return {sizeof(dubsar_sink_screen),
          s.width_px,
          s.height_px,
          s.window_x,
          s.window_y,
          s.window_w,
          s.window_h,
          0,
          s.width_mm,
          s.height_mm};
}

void host_off_axis_view(const dubsar_sink_screen* s, const dubsar_sink_viewer* v, const double* eye,
                        dubsar_sink_view* out) {
  const Screen screen{s->width_mm, s->height_mm, s->width_px, s->height_px,
                      s->window_x, s->window_y,  s->window_w, s->window_h};
  Observer viewer;
  viewer.left_mm = glm::make_vec3(v->left_mm);
  viewer.right_mm = glm::make_vec3(v->right_mm);
  viewer.front_mm = v->front_mm;
  viewer.back_mm = v->back_mm;
  const View view = viewer_view(screen.window_rect(), viewer, glm::make_vec3(eye));
  std::copy_n(glm::value_ptr(view.view_from_world), 16, out->view_from_screen);
  std::copy_n(glm::value_ptr(view.clip_from_view), 16, out->clip_from_view);
}

void host_log(const char* text) { log_info("plug-in: {}", text); }

constexpr dubsar_sink_host kHost{DUBSAR_SINK_ABI, sizeof(dubsar_sink_host), host_off_axis_view, host_log};

class PluginSink : public OutputSink {
 public:
  PluginSink(std::shared_ptr<SinkPlugin> plugin, const dubsar_sink_table& table, void* sink)
      : plugin_(std::move(plugin)), table_(table), sink_(sink) {}
  ~PluginSink() override { table_.destroy(sink_); }
  PluginSink(const PluginSink&) = delete;
  PluginSink& operator=(const PluginSink&) = delete;

  SinkTraits traits() const noexcept override {
    return {.name = plugin_->name(),
            .views = traits_.views,
            .view = {traits_.view_w, traits_.view_h},
            .output = {traits_.output_w, traits_.output_h},
            .tracked = (traits_.flags & DUBSAR_SINK_TRACKED) != 0,
            .exact_pixels = (traits_.flags & DUBSAR_SINK_EXACT_PIXELS) != 0,
            .fields = std::max(1, traits_.fields)};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    const dubsar_sink_screen given = abi_screen(screen);
    dubsar_sink_traits made{};
    made.size = sizeof(made);
    ErrorText error{};
    if (table_.configure(sink_, &given, &made, error.data(), error.size()) != 0)
      return fail(ErrorKind::kUsage, "display {}: {}", plugin_->name(), sentence(error));
    const auto side = [](int pixels) { return pixels >= 1 && pixels <= kMaxSide; };
    if (made.fields < 0 || made.fields > 2)
      return fail(ErrorKind::kBadData, "display {}: its plug-in wants {} fields, expected 1 or 2", plugin_->name(),
                  made.fields);
    if (made.views < 1 || made.views > kMaxViews || !side(made.view_w) || !side(made.view_h) || !side(made.output_w) ||
        !side(made.output_h))
      return fail(ErrorKind::kBadData,
                  "display {}: its plug-in wants {} views of {} x {} pixels for a picture of {} x {}, expected 1 to {} "
                  "views and 1 to {} pixels a side",
                  plugin_->name(), made.views, made.view_w, made.view_h, made.output_w, made.output_h, kMaxViews,
                  kMaxSide);
    traits_ = made;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override {
    dubsar_sink_viewer given{};
    given.size = sizeof(given);
    std::copy_n(glm::value_ptr(viewer.left_mm), 3, given.left_mm);
    std::copy_n(glm::value_ptr(viewer.right_mm), 3, given.right_mm);
    given.front_mm = viewer.front_mm;
    given.back_mm = viewer.back_mm;
    std::vector<dubsar_sink_view> made(static_cast<std::size_t>(traits_.views));
    views_.assign(made.size(), View());
    problem_.clear();
    ErrorText error{};
    if (table_.views(sink_, &given, made.data(), error.data(), error.size()) != 0) {
      problem_ = sentence(error);
      return views_;
    }
    for (std::size_t i = 0; i < made.size(); ++i) {
      const auto finite = [](double value) { return std::isfinite(value); };
      if (!std::all_of(std::begin(made[i].view_from_screen), std::end(made[i].view_from_screen), finite) ||
          !std::all_of(std::begin(made[i].clip_from_view), std::end(made[i].clip_from_view), finite)) {
        problem_ = fmt::format("view {} holds numbers that are not finite", i);
        return views_;
      }
      views_[i] = {glm::make_mat4(made[i].view_from_screen), glm::make_mat4(made[i].clip_from_view)};
    }
    return views_;
  }
  Result<void> compose(const ViewArray& views, const Surface& target, Field field) override {
    if (!problem_.empty()) return fail(ErrorKind::kBadData, "display {}: {}", plugin_->name(), problem_);
    const dubsar_sink_frame frame{
        sizeof(dubsar_sink_frame),       views.coded(), target.framebuffer, target.width, target.height,
        static_cast<std::int32_t>(field)};
    ErrorText error{};
    if (table_.compose(sink_, &frame, error.data(), error.size()) != 0)
      return fail(ErrorKind::kUnavailable, "display {}: {}", plugin_->name(), sentence(error));
    return check_gl("composing in a plug-in");
  }

 private:
  std::shared_ptr<SinkPlugin> plugin_;
  const dubsar_sink_table& table_;
  void* sink_;
  dubsar_sink_traits traits_{sizeof(dubsar_sink_traits), 0, 1, 1, 1, 1, 1, 0};
  std::vector<View> views_;
  std::string problem_;  ///< views() cannot fail, so compose() does
};

Result<void> check_table(const std::string& file, const dubsar_sink_table* table) {
  if (table == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: it refuses to work with ABI version {}", file, DUBSAR_SINK_ABI);
  DUBSAR_TRY(check_plugin_version(file, {table->abi, table->size}, {DUBSAR_SINK_ABI, sizeof(dubsar_sink_table)},
                                  "plugin_abi.h"));
  if (table->name == nullptr || table->summary == nullptr || table->create == nullptr || table->destroy == nullptr ||
      table->configure == nullptr || table->views == nullptr || table->compose == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: its table has gaps, expected every entry", file);
  const std::string_view name(table->name);
  DUBSAR_TRY(check_plugin_name(file, name));
  for (const SinkBackend& sink : output_sinks())
    if (sink.name == name)
      return fail(ErrorKind::kBadData, "plug-in {}: its name {} is that of a built-in display", file, name);
  return {};
}

}  // namespace

Result<std::shared_ptr<SinkPlugin>> SinkPlugin::load(const std::filesystem::path& file) {
  DUBSAR_ASSIGN(PluginLibrary library, PluginLibrary::load(file, DUBSAR_SINK_ENTRY));
  const dubsar_sink_table* const table = library.entry<dubsar_sink_entry>()(&kHost);
  DUBSAR_TRY(check_table(library.path(), table));
  return std::shared_ptr<SinkPlugin>(new SinkPlugin(std::move(library), table));
}

Result<std::unique_ptr<OutputSink>> SinkPlugin::create(const std::string& options) {
  ErrorText error{};
  void* const sink = table_->create(options.c_str(), error.data(), error.size());
  if (sink == nullptr) return fail(ErrorKind::kUsage, "display {}: {}", name(), sentence(error));
  return std::make_unique<PluginSink>(shared_from_this(), *table_, sink);
}

Result<std::vector<std::shared_ptr<SinkPlugin>>> load_plugins(const std::vector<std::string>& files) {
  std::vector<std::shared_ptr<SinkPlugin>> plugins;
  for (const std::string& file : files) {
    DUBSAR_ASSIGN(plugins.emplace_back(), SinkPlugin::load(file));
  }
  return plugins;
}

}  // namespace dubsar
