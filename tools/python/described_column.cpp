#include "described_column.hpp"

#include "components/types.hpp"

#include <algorithm>

namespace minamo::python {

namespace {

std::string_view kept(std::string text) { return *new std::string(std::move(text)); }

template <class T>
void create(World& world, const ComponentInfo& info, std::string_view table, const T& start) {
  const std::span<T> values = world.add_column<T>(info, table).values();
  std::fill(values.begin(), values.end(), start);
}

template <int Dim>
void create(World& world, const ComponentInfo& info, std::string_view table, DescribedColumn::Shape shape,
            double start) {
  switch (shape) {
  case DescribedColumn::Shape::scalar:
    return create<double>(world, info, table, start);
  case DescribedColumn::Shape::vector:
    return create<Vec<Dim>>(world, info, table, Vec<Dim>::Constant(start));
  case DescribedColumn::Shape::matrix:
    return create<Mat<Dim>>(world, info, table, Mat<Dim>::Constant(start));
  }
}

}  // namespace

DescribedColumn::DescribedColumn(std::string name, Shape shape, std::string unit, std::string symbol, Lifetime lifetime,
                                 double start)
    : shape_(shape),
      start_(start),
      info_(new ComponentInfo{kept(std::move(name)), kept(std::move(symbol)), kept(std::move(unit)), lifetime}) {}

std::string DescribedColumn::table() const { return std::string(info_->name.substr(0, info_->name.find('.'))); }

void DescribedColumn::create(World& world, std::string_view table, int dimension) const {
  if (world.components().contains(info_->name)) return;
  if (dimension == 2) {
    python::create<2>(world, *info_, table, shape_, start_);
  } else {
    python::create<3>(world, *info_, table, shape_, start_);
  }
}

}  // namespace minamo::python
