// A system cannot ask for the whole world.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
#ifdef MUST_FAIL
  void operator()(World& world) const { world.resource<Total>().value = 1; }
#else
  void operator()(Write<Total> T) const { T->value = 1; }
#endif
};

const System system_of_kernel = make_system<Kernel>("kernel");
