// A bundle of views cannot hold the whole world.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct HeightAndTotal {
  Read<Height> h;
#ifdef MUST_FAIL
  World* world;
#else
  Write<Total> T;
#endif
};

struct Kernel {
  void operator()(Uses<HeightAndTotal> of) const { (void)of; }
};

const System system_of_kernel = make_system<Kernel>("kernel");
