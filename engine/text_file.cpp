#include "engine/text_file.hpp"

#include <fstream>
#include <stdexcept>

namespace minamo {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  const fs::path unfinished = path.string() + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw std::runtime_error(path.string() + ": cannot be written");
  }
  fs::rename(unfinished, path);
}

}  // namespace minamo
