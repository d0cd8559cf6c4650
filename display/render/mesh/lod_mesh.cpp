#include "display/render/mesh/lod_mesh.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include "display/render/mesh/lod.h"

namespace dubsar {
namespace {

constexpr double kFinestGrid = 1024, kCoarsestGrid = 63.9, kGridStep = 0.70710678118654752;  // half the triangles each
constexpr double kWorthwhile = 0.75;              // of the triangles of the finer level
constexpr double kQuickGrid = 90;                 // some 100 000 triangles for a tablet in its envelope
constexpr std::size_t kSmallTriangles = 100'000;  // drawn as they are at once
constexpr std::size_t kUploadBytes = 8u << 20;    // a picture: some milliseconds

double longest_side(const PackedMesh& mesh) {
  const glm::dvec3 size = mesh.box_mm.size();
  return std::max({size.x, size.y, size.z});
}

/// Levels from the finest on, the mesh itself first. `take` says whether to go on.
template <class Take>
void make_levels(PackedMesh mesh, Take&& take) {
  const double longest = longest_side(mesh);
  sort_into_chunks(mesh);
  if (!take(mesh, 0.0)) return;
  for (double grid = kFinestGrid; grid >= kCoarsestGrid && longest > 0; grid *= kGridStep) {
    PackedMesh coarser = cluster_vertices(mesh, longest / grid);
    if (coarser.triangles.empty()) return;
    if (static_cast<double>(coarser.triangles.size()) > kWorthwhile * static_cast<double>(mesh.triangles.size()))
      continue;
    sort_into_chunks(coarser);
    if (!take(coarser, longest / grid)) return;
    mesh = std::move(coarser);
  }
}

}  // namespace

/// Levels that a thread makes, until they are taken.
class LodMesh::Growth {
 public:
  struct Made {
    PackedMesh mesh;
    double cell_mm = 0.0;
  };
  explicit Growth(PackedMesh mesh) : source_(std::move(mesh)) {}

  /// Once; nothing comes before.
  void begin() {
    if (!thread_.joinable())
      thread_ = std::jthread([this](const std::stop_token& stop) { run(std::move(source_), stop); });
  }

  std::optional<Made> take() {
    const std::scoped_lock lock(mutex_);
    if (made_.empty()) return std::nullopt;
    Made out = std::move(made_.front());
    made_.pop_front();
    return out;
  }
  /// Nothing will come any more.
  bool over() {
    const std::scoped_lock lock(mutex_);
    return over_ && made_.empty();
  }
  bool out_of_memory() {
    const std::scoped_lock lock(mutex_);
    return out_of_memory_;
  }

 private:
  void run(PackedMesh mesh, const std::stop_token& stop) {
    bool failed = false;
    try {
      make_levels(std::move(mesh), [&](const PackedMesh& level, double cell_mm) {
        Made made{level, cell_mm};
        const std::scoped_lock lock(mutex_);
        made_.push_back(std::move(made));
        return !stop.stop_requested();
      });
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    const std::scoped_lock lock(mutex_);
    out_of_memory_ = failed;
    over_ = true;
  }

  PackedMesh source_;  // the thread's from begin() on
  std::mutex mutex_;   // for the three below
  std::deque<Made> made_;
  bool over_ = false, out_of_memory_ = false;
  std::jthread thread_;  // goes first
};

/// A level on its way into graphics memory.
struct LodMesh::Coming {
  PackedMesh mesh;
  GpuMesh gpu;
  double cell_mm = 0.0;
};

LodMesh::LodMesh() = default;
LodMesh::LodMesh(LodMesh&&) noexcept = default;
LodMesh& LodMesh::operator=(LodMesh&&) noexcept = default;
LodMesh::~LodMesh() = default;

void LodMesh::describe(const PackedMesh& mesh) {
  partition_box_mm_ = mesh.partition_box_mm;
  for (int p = 0; p < kMaxPartitions; ++p)
    if (mesh.first_triangle[p] < mesh.first_triangle[p + 1])
      has_triangles_ = static_cast<std::uint8_t>(has_triangles_ | 1 << p);
}

Result<void> LodMesh::add(const PackedMesh& level, double cell_mm) {
  DUBSAR_ASSIGN(GpuMesh gpu, GpuMesh::upload(level));
  return insert(std::move(gpu), cell_mm, level.triangles.size());
}

Result<void> LodMesh::insert(GpuMesh gpu, double cell_mm, std::size_t triangles) {
  if (fields_) DUBSAR_TRY(gpu.carry(*fields_));
  const auto place = std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.cell_mm > cell_mm; });
  levels_.insert(place, {std::move(gpu), cell_mm, static_cast<std::int64_t>(triangles), false});
  return {};
}

Result<LodMesh> LodMesh::exact(const PackedMesh& mesh) {
  LodMesh out;
  out.describe(mesh);
  DUBSAR_TRY(out.add(mesh, 0.0));
  return out;
}

Result<LodMesh> LodMesh::growing(PackedMesh mesh) {
  LodMesh out;
  out.describe(mesh);
  const double longest = longest_side(mesh);
  PackedMesh quick;
  if (mesh.triangles.size() > kSmallTriangles && longest > 0) quick = quick_clusters(mesh, longest / kQuickGrid);
  if (quick.triangles.empty())
    DUBSAR_TRY(out.add(mesh, 0.0));
  else
    DUBSAR_TRY(out.add(quick, longest / kQuickGrid));
  out.levels_.front().quick = true;
  out.growth_ = std::make_unique<Growth>(std::move(mesh));
  return out;
}

Result<void> LodMesh::carry(std::shared_ptr<const SurfaceFields> fields) {
  for (Level& level : levels_) DUBSAR_TRY(level.mesh.carry(*fields));
  fields_ = std::move(fields);
  return {};
}

Result<void> carry_fields(LodMesh& levels, const TriMesh& mesh, const FieldNeeds& needs, Progress& progress) {
  const SurfaceFields* const had = levels.fields();
  const FieldNeeds missing = had != nullptr ? needs.without(had->has) : needs;
  if (!missing.any()) return {};
  DUBSAR_ASSIGN(SurfaceFields made, measure_fields(mesh, missing, progress));
  if (had != nullptr) made = joined(std::move(made), *had);
  return levels.carry(std::make_shared<const SurfaceFields>(std::move(made)));
}

Result<bool> LodMesh::update() {
  if (growth_ == nullptr) return false;
  growth_->begin();
  if (growth_->out_of_memory())
    return fail(ErrorKind::kTryAgain, "render: no memory for the levels of detail of this mesh");
  if (!coming_) {
    auto made = growth_->take();
    if (!made) {
      if (growth_->over()) growth_.reset();
      return false;
    }
    DUBSAR_ASSIGN(GpuMesh room, GpuMesh::reserve(made->mesh));
    coming_ = std::make_unique<Coming>(Coming{std::move(made->mesh), std::move(room), made->cell_mm});
  }
  DUBSAR_ASSIGN(const bool whole, coming_->gpu.upload_some(coming_->mesh, kUploadBytes));
  if (!whole) return false;
  const std::unique_ptr<Coming> came = std::move(coming_);
  const double cell_mm = came->cell_mm;
  const bool finest = cell_mm <= levels_.front().cell_mm;
  // A level of the same fineness, made with care, takes the place of the one that came first.
  std::erase_if(levels_, [&](const Level& level) {
    return level.quick && (level.cell_mm == 0.0 ? cell_mm == 0.0 : cell_mm >= 0.99 * level.cell_mm);
  });
  DUBSAR_TRY(insert(std::move(came->gpu), cell_mm, came->mesh.triangles.size()));
  return finest;
}

int LodMesh::level_for(double cell_mm) const noexcept {
  int best = 0;
  for (int i = 1; i < levels(); ++i)
    if (levels_[static_cast<std::size_t>(i)].cell_mm <= cell_mm) best = i;
  return best;
}

Box LodMesh::box_of(std::uint8_t partitions) const {
  return joined_box(partition_box_mm_, static_cast<std::uint8_t>(partitions & has_triangles_));
}

}  // namespace dubsar
