#include "engine/storage/file_error.hpp"

#include <cctype>
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace minamo {

std::string reason(int error) {
  if (error == 0) return {};
  std::string why = std::generic_category().message(error);
  why[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(why[0])));
  return ": " + why;
}

std::string not_written(const std::string& path, int error) { return path + ": cannot be written" + reason(error); }

void throw_not_written(const std::string& path) { throw std::runtime_error(not_written(path, errno)); }

}  // namespace minamo
