// A kernel cannot change itself: its run must not depend on earlier runs.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  int calls = 0;
#ifdef MUST_FAIL
  void operator()(Read<Total>) { ++calls; }
#else
  void operator()(Read<Total>) const {}
#endif
};

const System system_of_kernel = make_system<Kernel>("kernel");
