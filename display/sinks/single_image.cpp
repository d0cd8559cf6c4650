#include "display/sinks/single_image.h"

#include <algorithm>

#include "core/image_io/png_file.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/mono.h"

namespace dubsar {
namespace {

class ImageSink : public OutputSink {
 public:
  ImageSink(std::string path, std::unique_ptr<OutputSink> mono) : path_(std::move(path)), mono_(std::move(mono)) {}

  SinkTraits traits() const noexcept override {
    SinkTraits traits = mono_->traits();
    traits.name = "image";
    return traits;
  }
  Result<void> configure(const Screen& screen) override { return mono_->configure(screen); }
  std::span<const View> views(const Observer& viewer) override { return mono_->views(viewer); }

  Result<void> compose(const ViewArray& views, const Surface& target, Field field) override {
    DUBSAR_TRY(mono_->compose(views, target, field));
    DUBSAR_ASSIGN(const Image picture, views.read_layer(0));
    std::string path = path_;
    const auto percent = path.find('%');
    if (percent != std::string::npos) path.replace(percent, 1, fmt::format("{:05}", frame_));
    ++frame_;
    return write_png(path, picture);
  }

 private:
  std::string path_;
  std::unique_ptr<OutputSink> mono_;
  int frame_ = 0;
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_image_sink(SinkOptions options) {
  const std::string path = options.text("path").value_or("");
  DUBSAR_TRY(options.finish("path=FILE.png"));
  if (path.empty() || std::filesystem::path(path).extension() != ".png" ||
      std::count(path.begin(), path.end(), '%') > 1)
    return fail(ErrorKind::kUsage,
                "display image: path \"{}\" found, expected path=FILE.png with at most one % for the frame number",
                path);
  DUBSAR_ASSIGN(auto mono, make_mono_sink(SinkOptions({"mono"}, built_in_panels())));
  return std::make_unique<ImageSink>(path, std::move(mono));
}

}  // namespace dubsar
