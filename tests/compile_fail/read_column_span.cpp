// A column that is only read gives no span to write through.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Read<Height> h) const {
#ifdef MUST_FAIL
    const std::span<double> values = h.span();
    (void)values;
#else
    const std::span<const double> values = h.span();
    (void)values;
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
