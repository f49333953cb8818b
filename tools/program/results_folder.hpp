#pragma once
/// \file
/// The folder of a run's results: whose it is while the run lasts, what of an earlier run goes, and what must stay.

#include "engine/input/input.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace minamo {

/// The scene with its defaults, in the folder of its results.
inline constexpr const char* scene_as_run = "scene.json";

/// Keeps other runs out of a folder for as long as it lives. It is a lock of the folder itself, which leaves no file
/// and ends with the process, however that ends. Where the file system has no such locks, it keeps out nobody.
class FolderClaim {
 public:
  FolderClaim() = default;
  /// A folder that is not there is claimed by nobody. \throws InputError if another run has it
  explicit FolderClaim(const std::filesystem::path& folder);
  ~FolderClaim();
  FolderClaim(FolderClaim&& other) noexcept;
  FolderClaim& operator=(FolderClaim&& other) noexcept;

 private:
  int descriptor_ = -1;
};

/// Makes a folder for results, which may be there already. \throws InputError
void make_output_folder(const std::filesystem::path& folder);

/// \throws InputError: the folder cannot have results
[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const std::string& what);

/// Removes what an earlier run has left, and no other file. \throws InputError
void remove_results(const std::filesystem::path& folder);

/// Whether a file is there and has just this text.
bool holds(const std::filesystem::path& file, const std::string& text);

/// The files that a scene as understood refers to: it has their whole paths.
std::vector<std::filesystem::path> files_named_in(const Json& scene);

/// \throws InputError for every input that a run into the folder would replace or remove
void require_kept(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder);
/// The same for what writes files of some names there.
void require_kept(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder,
                  std::span<const char* const> names);

}  // namespace minamo
