// The right to read is not the right to write.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Read<Height> h) const {
#ifdef MUST_FAIL
    const Write<Height> again = h;
    (void)again;
#else
    const Read<Height> again = h;
    (void)again;
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
