#include "tools/program/version.hpp"

#include "minamo_build.hpp"
#include "minamo_version.hpp"

#include <Eigen/Core>
#include <SuiteSparse_config.h>
#include <hdf5.h>
#include <spdlog/fmt/fmt.h>
#include <tbb/version.h>

#include <array>
#include <utility>

// There in the program only if its BLAS is OpenBLAS.
extern "C" const char* openblas_get_config() __attribute__((weak));

namespace minamo {

namespace {

using Json = nlohmann::ordered_json;

Json package_versions() {
  std::array<int, 3> suitesparse{};
  SuiteSparse_version(suitesparse.data());
  std::array<unsigned, 3> hdf5{};
  H5get_libversion(&hdf5[0], &hdf5[1], &hdf5[2]);
  Json packages{
      {"oneTBB", TBB_runtime_version()},
      {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"SuiteSparse", fmt::format("{}.{}.{}", suitesparse[0], suitesparse[1], suitesparse[2])},
      {"HDF5", fmt::format("{}.{}.{}", hdf5[0], hdf5[1], hdf5[2])},
  };
  if (openblas_get_config) packages["BLAS"] = openblas_get_config();
  return packages;
}

}  // namespace

Json build_facts() {
  Json facts;
  for (const auto& [name, fact] : {std::pair("commit", build::commit), std::pair("compiler", build::compiler),
                                   std::pair("type", build::type), std::pair("flags", build::flags),
                                   std::pair("options", build::options), std::pair("processor", build::processor)}) {
    if (!fact.empty()) facts[name] = fact;
  }
  facts["packages"] = package_versions();
  return facts;
}

std::string version_text() {
  std::string text = fmt::format("minamo {}", version);
  const auto add_lines = [&](const Json& facts) {
    for (const auto& [name, fact] : facts.items()) {
      if (fact.is_string()) text += fmt::format("\n{:12} {}", name, fact.get<std::string>());
    }
  };
  const Json facts = build_facts();
  if (!facts.contains("commit")) text += fmt::format("\n{:12} {}", "commit", "unknown: not built in a checkout of git");
  add_lines(facts);
  add_lines(facts["packages"]);
  return text;
}

}  // namespace minamo
