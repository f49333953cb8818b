// The right to write a column is not the right to resize its table.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Write<Height> h, Resize<Rows> rows) const {
#ifdef MUST_FAIL
    h.resize(rows.rows());
#else
    rows.resize(h.size());
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
