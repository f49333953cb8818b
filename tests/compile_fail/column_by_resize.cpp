// The right to resize a table gives no column of it.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Resize<Rows> rows, Write<Height> h) const {
#ifdef MUST_FAIL
    rows[0] = h[0];
#else
    h[0] = static_cast<double>(rows.rows());
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
