#include "engine/system.hpp"

namespace minamo::detail {

namespace {

std::function<void(World&)> run_without(const Absent& absent, const Erased& erased) {
  return [run = erased.run, kernel = erased.kernel, absent](World& world) { run(kernel.get(), world, absent); };
}

}  // namespace

System make_system(std::string name, const Erased& erased) {
  System system{std::move(name),
                {erased.access.begin(), erased.access.end()},
                [create = erased.create](World& world) {
                  for (const auto create_one : create) create_one(world);
                },
                run_without({}, erased)};
  system.without = [erased, rest = system](const Absent& absent) {
    System less = rest;
    less.run = run_without(absent, erased);
    std::erase_if(less.access, [&](const Access& access) {
      return access.optional && std::find(absent.begin(), absent.end(), access.component) != absent.end();
    });
    return less;
  };
  return system;
}

}  // namespace minamo::detail
