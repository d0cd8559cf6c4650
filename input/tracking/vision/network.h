#pragma once
// A network that runs: pictures in, rows of numbers out. OpenCV's dnn behind it.

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "input/tracking/vision/net_graph.h"

namespace dubsar {

class Network {
 public:
  /// kBadData: the graph is not sound (check_graph), or has an output that is a picture.
  static Result<Network> build(const NetGraph& graph, std::string_view source);
  /// A .tflite file of at most 32 MiB. kNoInput, kPermission, kBadData.
  static Result<Network> read(const std::filesystem::path& path);

  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  ~Network();

  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  int channels() const noexcept { return channels_; }

  /// `planes`: channel after channel, each rows x columns. `outputs`: in the order of the graph, values in
  /// the order that the file's shapes say; lends its memory, so keep handing in the same object. One thread
  /// at a time, and only one is used for the work, so that results do not depend on the machine. kInternal:
  /// OpenCV refused.
  Result<void> run(std::span<const float> planes, std::vector<std::vector<float>>& outputs);

 private:
  struct Impl;
  explicit Network(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
  int rows_ = 0, columns_ = 0, channels_ = 0;
};

}  // namespace dubsar
