// A loop over a column that is only read cannot write it.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Read<Height> h) const {
#ifdef MUST_FAIL
    for (double& value : h) value = 1;
#else
    for (const double& value : h) (void)value;
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
