// A material that is in no library: made here, put into a scene that is read from a file, and run.
// Usage: add_material SCENE FOLDER

#include <cstdio>

#include "poreshock/core/parallel.hpp"
#include "poreshock/run/run.hpp"
#include "poreshock/scene/read_scene.hpp"

int main(int argc, char** argv) {
  const poreshock::Runtime runtime(argc, argv);
  if (argc < 3) return 2;

  poreshock::MaterialParameters tantalum;
  tantalum.name = "tantalum";
  tantalum.density = 16650.0;
  tantalum.young = 186.0e9;
  tantalum.poisson = 0.34;
  tantalum.yield = 0.77e9;
  tantalum.c0 = 3410.0;
  tantalum.lambda = 1.2;
  tantalum.gamma = 1.67;
  tantalum.cv = 140.0;

  poreshock::Scene scene = poreshock::read_scene(argv[1]);
  scene.materials = {tantalum};

  poreshock::RunOptions options;
  options.folder = argv[2];
  options.rows = poreshock::ProgressRows::none;
  poreshock::run<2>(scene, options, runtime.communicator());
  if (poreshock::rank(runtime.communicator()) == 0) std::printf("ran with tantalum\n");
}
