#pragma once
/// \file
/// What the tests were linked with. Their objects are those of all builds.

#include <filesystem>
#include <string>

// Where the address sanitizer is, it defines this.
extern "C" __attribute__((weak)) void __asan_init();

namespace minamo {

/// Whether the library is that of the address sanitizer.
inline bool is_address_sanitized() { return __asan_init != nullptr; }

/// The program of the same build: it lies next to the tests.
inline std::string program_path() {
  return (std::filesystem::canonical("/proc/self/exe").parent_path() / "minamo").string();
}

}  // namespace minamo
