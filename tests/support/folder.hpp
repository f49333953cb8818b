#pragma once
/// \file
/// A folder for the files of one test, gone when the test ends.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

namespace minamo {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "minamo_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Files of two folders that are not byte for byte the same.
inline std::vector<std::string> differing_files(const std::string& a, const std::string& b,
                                                const std::vector<std::string>& names) {
  std::vector<std::string> differing;
  for (const std::string& name : names) {
    if (text_of(a + "/" + name) != text_of(b + "/" + name)) differing.push_back(name);
  }
  return differing;
}

}  // namespace minamo
