// A row of a column that is only read cannot be written.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Read<Height> h) const {
#ifdef MUST_FAIL
    h[0] = 1;
#else
    (void)h[0];
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
