#include "engine/storage/text_file.hpp"

#include "engine/storage/file_error.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>

namespace minamo {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  const fs::path unfinished = path.string() + ".unfinished";
  errno = 0;
  std::ofstream file(unfinished, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    const int why = errno;
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw std::runtime_error(not_written(path.string(), why));
  }
  fs::rename(unfinished, path);
}

}  // namespace minamo
