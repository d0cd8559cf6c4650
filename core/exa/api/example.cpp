// exa_to_obj FILE.exa [FILE.obj]: says what an EXA file holds, and writes its triangles as Wavefront OBJ. Shows how to
// use libdubsar-exa: nothing of dubsar but dubsar_exa.h is included.

#include <fstream>
#include <iostream>

#include "dubsar_exa.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "exa_to_obj FILE.exa [FILE.obj]\n";
    return 64;
  }
  dubsar_exa::Info info;
  dubsar_exa::Surface surface;
  std::string error;
  if (!dubsar_exa::read_info(argv[1], info, error) || !dubsar_exa::read(argv[1], {}, surface, error)) {
    std::cerr << error << '\n';
    return 65;
  }
  std::cout << info.grid[0] << " x " << info.grid[1] << " x " << info.grid[2] << " points, " << info.bytes
            << " bytes by " << info.tool << '\n'
            << surface.positions_mm.size() << " vertices, " << surface.triangles.size() << " triangles, "
            << surface.partitions.size() << " partitions\n";
  if (argc < 3) return 0;
  std::ofstream out(argv[2]);
  for (const auto& p : surface.positions_mm) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& t : surface.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return out.flush() ? 0 : 74;
}
