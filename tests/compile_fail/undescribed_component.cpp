// What has no ComponentInfo is not a component.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Undescribed {
  double value = 0;
};

struct Kernel {
#ifdef MUST_FAIL
  void operator()(Read<Undescribed>) const {}
#else
  void operator()(Read<Total>) const {}
#endif
};

const System system_of_kernel = make_system<Kernel>("kernel");
