// A resource that is only read cannot be written.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Read<Total> T) const {
#ifdef MUST_FAIL
    T->value = 1;
#else
    (void)T->value;
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
