#include "columns.hpp"

#include <algorithm>
#include <map>

namespace minamo::python {

/// Lives as long as the array, whose base it is; slices of the array keep the array.
struct Views::View {
  Storage* column;
  const void* buffer;
  Writable writable;
  std::shared_ptr<void> owner;
  PyObject* array = nullptr;
};

namespace {

py::dtype type_of(const ValueLayout& layout) {
  const char* kind = layout.number == ValueLayout::Number::real      ? "f"
                     : layout.number == ValueLayout::Number::integer ? "i"
                                                                     : "u";
  return py::dtype(kind + std::to_string(layout.number_bytes));
}

int& flags_of(PyObject* array) { return py::detail::array_proxy(array)->flags; }

void forbid_writing(PyObject* array) { flags_of(array) &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_; }

py::array make_array(Storage& column, py::handle base) {
  const ValueLayout layout = column.layout();
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(column.rows())};
  std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(column.value_bytes())};
  for (int a = 0; a < layout.axes; ++a) {
    shape.push_back(static_cast<py::ssize_t>(layout.axis[static_cast<std::size_t>(a)].extent));
    strides.push_back(static_cast<py::ssize_t>(layout.axis[static_cast<std::size_t>(a)].stride));
  }
  return {type_of(layout), shape, strides, column.bytes().data(), base};
}

}  // namespace

py::array Views::view(Storage& column, Writable writable, const std::shared_ptr<void>& owner) {
  std::erase_if(views_, [](const auto& weak) { return weak.expired(); });
  const void* buffer = column.bytes().data();
  for (const auto& weak : views_) {
    const std::shared_ptr<View> known = weak.lock();
    if (known->column == &column && known->buffer == buffer && known->writable == writable && known->array)
      return py::reinterpret_borrow<py::array>(known->array);
  }
  auto view = std::make_shared<View>(View{&column, buffer, writable, owner});
  const py::capsule base(new std::shared_ptr<View>(view),
                         [](void* held) { delete static_cast<std::shared_ptr<View>*>(held); });
  py::array array = make_array(column, base);
  view->array = array.ptr();
  if (writable == Writable::no) forbid_writing(array.ptr());
  if (writable == Writable::yes && std::find(written_.begin(), written_.end(), &column) == written_.end())
    written_.push_back(&column);
  views_.push_back(view);
  return array;
}

void Views::detach() {
  std::map<const void*, std::shared_ptr<void>> given;  // by buffer: a writable and a read-only array share one
  for (const auto& weak : views_) {
    const std::shared_ptr<View> view = weak.lock();
    if (!view) continue;
    auto& memory = given[view->buffer];
    if (!memory) memory = view->column->give_away(view->buffer);
    view->owner = memory;
    forbid_writing(view->array);
  }
  views_.clear();
  written_.clear();
}

bool Views::are_held() const {
  return std::any_of(views_.begin(), views_.end(), [](const auto& weak) { return !weak.expired(); });
}

}  // namespace minamo::python
