#include "tools/program/results_folder.hpp"

#include "systems/output/history.hpp"
#include "systems/output/surface/surface_folder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace minamo {

namespace {

namespace fs = std::filesystem;

/// What goes when a run begins. The scene as run is replaced, so that there is one at every moment.
constexpr std::array<const char*, 8> removed{"history.csv", history_units_name, "fields.h5",     "fields.xdmf",
                                             surface_index, "summary.json",     "checkpoint.h5", "trace.json"};

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

bool is_one_of(std::span<const char* const> names, const fs::path& file, const fs::path& folder) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return is_same_file(file, folder / name); });
}

/// Whether a run into the folder writes or removes a file.
bool is_result(const fs::path& file, const fs::path& folder) {
  if (is_same_file(file, folder / scene_as_run) || is_one_of(removed, file, folder)) return true;
  const fs::path surfaces = surface_path(folder, 0, SurfaceFormat::vtp).parent_path();
  return frame_of_surface(folder, file) && is_same_file(file, surfaces / file.filename());
}

void refuse_inputs(const std::vector<fs::path>& inputs, const fs::path& folder,
                   const std::function<bool(const fs::path&)>& is_replaced) {
  std::vector<Problem> problems;
  for (const fs::path& input : inputs) {
    if (!is_replaced(input)) continue;
    problems.push_back({input.string(),
                        {},
                        "is an input that a result would replace",
                        "another folder for the results (--out)",
                        shown(Json(folder.string())),
                        {}});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

FolderClaim::FolderClaim(const fs::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  descriptor_ = -1;
  throw InputError(
      {{folder.string(), {}, "another run is writing here", "a folder of its own for every run (--out)", {}, {}}});
}

FolderClaim::~FolderClaim() {
  if (descriptor_ >= 0) close(descriptor_);
}

FolderClaim::FolderClaim(FolderClaim&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderClaim& FolderClaim::operator=(FolderClaim&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void refuse_folder(const fs::path& folder, const std::string& what) {
  throw InputError({{folder.string(), {}, what, "a folder for the results (--out)", {}, {}}});
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::exists(folder) && !fs::is_directory(folder)) refuse_folder(folder, "is a file");
  if (error) refuse_folder(folder, fmt::format("cannot be made: {}", error.message()));
}

void remove_results(const fs::path& folder) {
  for (const char* name : removed) {
    std::error_code error;
    fs::remove(folder / name, error);
    if (error) refuse_folder(folder, fmt::format("{} cannot be removed: {}", name, error.message()));
  }
  try {
    remove_surfaces(folder, 0);
  } catch (const fs::filesystem_error& error) {
    const std::string name = error.path1().lexically_relative(folder).string();
    refuse_folder(folder, fmt::format("{} cannot be removed: {}", name, error.code().message()));
  }
}

bool holds(const fs::path& file, const std::string& text) {
  std::error_code missing;
  if (fs::file_size(file, missing) != text.size() || missing) return false;
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {}) == text;
}

std::vector<fs::path> files_named_in(const Json& scene) {
  std::vector<fs::path> files;
  const Json values = scene.flatten();
  for (const auto& [pointer, value] : values.items()) {
    const fs::path path = value.is_string() ? value.get<std::string>() : std::string();
    std::error_code not_there;
    if (path.is_absolute() && fs::is_regular_file(path, not_there)) files.push_back(path);
  }
  return files;
}

void require_kept(const std::vector<fs::path>& inputs, const fs::path& folder) {
  refuse_inputs(inputs, folder, [&](const fs::path& input) { return is_result(input, folder); });
}

void require_kept(const std::vector<fs::path>& inputs, const fs::path& folder, std::span<const char* const> names) {
  refuse_inputs(inputs, folder, [&](const fs::path& input) { return is_one_of(names, input, folder); });
}

}  // namespace minamo
