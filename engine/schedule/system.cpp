#include "engine/schedule/system.hpp"

namespace minamo::detail {

namespace {

using Kernel = std::shared_ptr<const void>;

/// What is optional is not created for the sake of a reader.
void create(std::span<const Access> accesses, World& world) {
  for (const Access& access : accesses) {
    if (is_of_table(access.mode)) {
      world.add_table(access.table);
    } else if (!access.optional) {
      world.stored(*access.type);
    }
  }
}

std::function<void(World&)> run_without(const Absent& absent, const Erased& erased, const Kernel& kernel) {
  return [run = erased.run, kernel, absent](World& world) { run(kernel.get(), world, absent); };
}

}  // namespace

System make_system(std::string name, const Erased& erased, Kernel kernel) {
  System system{std::move(name),
                {erased.access.begin(), erased.access.end()},
                [access = erased.access](World& world) { create(access, world); },
                run_without({}, erased, kernel)};
  system.without = [erased, kernel = std::move(kernel), rest = system](const Absent& absent) {
    System less = rest;
    less.run = run_without(absent, erased, kernel);
    std::erase_if(less.access, [&](const Access& access) {
      return access.optional && std::find(absent.begin(), absent.end(), access.component) != absent.end();
    });
    return less;
  };
  return system;
}

}  // namespace minamo::detail
