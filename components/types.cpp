#include "components/types.hpp"

namespace minamo {

template class ColumnStorage<Vec<1>>;
template class ColumnStorage<Vec<2>>;
template class ColumnStorage<Vec<3>>;
template class ColumnStorage<Mat<2>>;
template class ColumnStorage<Mat<3>>;
template class ColumnStorage<Index<2>>;
template class ColumnStorage<Index<3>>;

}  // namespace minamo
