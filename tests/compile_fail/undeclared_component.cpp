// From the views of a system there is no way to a component that it does not declare.
#include "tests/compile_fail/components.hpp"

using namespace minamo;

struct Kernel {
  void operator()(Resize<Rows> rows, Update<Height> h) const {
#ifdef MUST_FAIL
    rows.world_->resource<Total>().value = 1;
#else
    rows.resize(h.size());
#endif
  }
};

const System system_of_kernel = make_system<Kernel>("kernel");
