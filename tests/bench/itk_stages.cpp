// What ITK takes for resampling and denoising: itk_stages VOLUME.raw SIZE [RUNS]. Prints a JSON object of seconds of a
// core by stage, the least of some runs. It has no joint bilateral filter: its bilateral filter over the same window is
// nearest to it.

#include <itkBilateralImageFilter.h>
#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>
#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkShrinkImageFilter.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace {

using Image = itk::Image<float, 3>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A new filter each time: a filter that has run does nothing.
template <class MakeFilter>
double least(int runs, const MakeFilter& make) {
  double best = 1e30;
  for (int run = 0; run < runs; ++run) {
    const auto filter = make();
    const double before = cpu_seconds();
    filter->Update();
    best = std::min(best, cpu_seconds() - before);
  }
  return best;
}

int run(const std::string& path, std::size_t size, int runs) {
  std::vector<float> voxels(size * size * size);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(voxels.data()), static_cast<std::streamsize>(4 * voxels.size()))) {
    std::fprintf(stderr, "%s: not %zu^3 floats\n", path.c_str(), size);
    return 66;
  }
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(1);
  const auto import = itk::ImportImageFilter<float, 3>::New();
  Image::RegionType region;
  region.SetSize({{size, size, size}});
  import->SetRegion(region);
  import->SetImportPointer(voxels.data(), voxels.size(), false);
  import->Update();
  Image* const input = import->GetOutput();

  itk::DiscreteGaussianImageFilter<Image, Image>::Pointer gauss;  // an image does not keep the filter that makes it
  const double resample = least(runs, [&] {
    gauss = itk::DiscreteGaussianImageFilter<Image, Image>::New();
    gauss->SetInput(input);
    gauss->SetVariance(0.72134752);  // 1 2 1
    gauss->SetMaximumKernelWidth(3);
    gauss->SetMaximumError(0.3);
    gauss->SetUseImageSpacing(false);
    const auto shrink = itk::ShrinkImageFilter<Image, Image>::New();
    shrink->SetInput(gauss->GetOutput());
    shrink->SetShrinkFactors(2);
    return shrink;
  });
  const double denoise = least(runs, [&] {
    const auto bilateral = itk::BilateralImageFilter<Image, Image>::New();
    bilateral->SetInput(input);
    bilateral->SetAutomaticKernelSize(false);
    bilateral->SetRadius(1);
    bilateral->SetDomainSigma(0.85);
    bilateral->SetRangeSigma(0.2);
    return bilateral;
  });
  std::printf("{\"resample\": %.4f, \"denoise\": %.4f}\n", resample, denoise);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("use: itk_stages VOLUME.raw SIZE [RUNS]\n", stderr);
    return 64;
  }
  return run(argv[1], static_cast<std::size_t>(std::atoll(argv[2])), argc > 3 ? std::atoi(argv[3]) : 3);
}
