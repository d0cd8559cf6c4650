// The only file that includes OpenCV's dnn.

#include "input/tracking/vision/network.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <opencv2/dnn.hpp>
#include <string>

#include "core/base/files/file_fingerprint.h"
#include "core/base/files/input_file.h"

namespace dubsar {

struct Network::Impl {
  int size_px = 0;
  cv::dnn::Net net;
  std::vector<cv::String> names;
  std::vector<cv::Mat> results;
};

Network::Network(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;
Network::~Network() = default;

Result<Network> Network::read(const std::filesystem::path& folder, const ModelFile& file) {
  const std::filesystem::path path = folder / file.name;
  DUBSAR_ASSIGN(const InputFile input, InputFile::open(path));
  if (input.size() != file.bytes)
    return fail(ErrorKind::kBadData, "{}: {} bytes found, expected {}; {} writes it anew", path.string(), input.size(),
                file.bytes, kModelCommand);
  DUBSAR_ASSIGN(const std::string bytes, read_bytes(input, 0, input.size()));
  if (bytes_checksum(bytes) != file.checksum)
    return fail(ErrorKind::kBadData, "{}: not the network that was expected: its checksum differs; {} writes it anew",
                path.string(), kModelCommand);
  auto impl = std::make_unique<Impl>();
  impl->size_px = file.size_px;
  try {
    cv::setNumThreads(1);
    impl->net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    impl->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    impl->net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    impl->names = impl->net.getUnconnectedOutLayersNames();
    std::sort(impl->names.begin(), impl->names.end());  // they end in output_00, output_01 ...
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kBadData, "{}: OpenCV does not take it: {}", path.string(), exception.what());
  }
  Network network(std::move(impl));
  // a first run makes OpenCV allocate and fuse, and shows a network that it cannot run
  std::vector<std::vector<float>> outputs;
  const auto side = static_cast<std::size_t>(file.size_px);
  if (auto ran = network.run(std::vector<float>(3 * side * side), outputs); !ran)
    return fail(ErrorKind::kBadData, "{}: {}", path.string(), ran.error().message);
  return network;
}

Result<void> Network::run(std::span<const float> planes, std::vector<std::vector<float>>& outputs) {
  const auto side = static_cast<std::size_t>(impl_->size_px);
  DUBSAR_CHECK(planes.size() == 3 * side * side);
  try {
    const int size[] = {1, 3, impl_->size_px, impl_->size_px};
    impl_->net.setInput(cv::Mat(4, size, CV_32F, const_cast<float*>(planes.data())));
    impl_->net.forward(impl_->results, impl_->names);
    outputs.resize(impl_->names.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const cv::Mat& result = impl_->results[i];
      if (result.type() != CV_32F || !result.isContinuous())
        return fail(ErrorKind::kInternal, "network: output {} is no list of 32-bit floats", i);
      const auto* const values = result.ptr<float>();
      outputs[i].assign(values, values + result.total());
    }
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kInternal, "network: {}", exception.what());
  }
  return {};
}

}  // namespace dubsar
