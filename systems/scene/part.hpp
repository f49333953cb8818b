#pragma once
/// \file
/// A part is the unit in which minamo grows: one feature, or one choice among registered schemes. It reads its key of
/// the scene, so that checks, schema and documentation come by themselves, and then adds what the run needs of it: its
/// systems to the slots of the step, and what it seeds. systems/step/register.cpp lists the built-in parts; a program
/// that links minamo registers its own in the same way.

#include "engine/schedule/registry.hpp"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

struct Scene;

/// Where problems of seeding are noted: what can only be seen once there are particles.
struct SeedProblems {
  std::string file;               ///< the scene
  std::vector<Problem> problems;  ///< found so far
  /// Adds one; `pointer` is that of the key in the scene.
  void note(std::string pointer, std::string what, std::string expected, std::string got) {
    problems.push_back({file, std::move(pointer), std::move(what), std::move(expected), std::move(got), {}});
  }
};

/// Fills constants and state of a world before the run.
using Seed = std::function<void(const Scene&, World&, SeedProblems&)>;

/// In which lists a system runs: in every step, in the standing steps before the first one, or in both. A standing step
/// is a backward Euler step that leaves the particles where they are; it gives the first pressure and acceleration.
enum class When { always, step, standing };

/// A slot of the step, in the order of the step.
struct Slot {
  std::string_view name;  ///< as in scenes and in Recipe::add()
  std::string_view doc;   ///< what holds after it
};
/// All slots, in the order of the step.
const std::vector<Slot>& slots();
/// The first of the slots whose systems run only in steps that the history has a row of.
inline constexpr std::string_view record_slots = "measure";

/// What a run is made of.
class Recipe {
 public:
  /// A system in a slot.
  struct Placed {
    std::string_view slot;  ///< its name
    When when;              ///< in which lists
    System system;          ///< what runs
  };
  /// A standing step: `configure`, the slots up to `solve`, and then `after`.
  struct StandingStep {
    System configure;           ///< takes the place of the slot `configure`
    std::vector<System> after;  ///< what follows the slot `solve`
  };

  Recipe() = default;
  /// \param dimension  2 or 3
  Recipe(const SystemRegistry& registry, int dimension) : registry_(&registry), dimension_(dimension) {}

  /// Makes the systems of a row of the step's table, `<p2g>`; of a row with a loop it is given what the loop repeats.
  using Maker = std::function<std::vector<System>(std::vector<System> body)>;
  /// Says what a row of the table is whose systems only this part can make.
  void fill(const std::string& row, Maker make) { makers_.insert_or_assign(row, std::move(make)); }
  /// The same for systems that are known.
  void fill(const std::string& row, std::vector<System> systems) {
    fill(row, [systems = std::move(systems)](const std::vector<System>&) { return systems; });
  }
  /// The same for registered systems without options.
  void fill(const std::string& row, const std::vector<std::string>& systems);
  /// What fill() has filled.
  const std::map<std::string, Maker>& makers() const { return makers_; }

  /// Adds a registered system to a slot, unless the slot has it already: in its row of the step's table if it has one
  /// there, else behind the rows.
  /// \throws std::logic_error for an unknown slot, std::out_of_range for an unknown system.
  void add(std::string_view slot, const std::string& system, When when = When::always);
  /// The same for a system with options.
  void add(std::string_view slot, System system, When when = When::always);
  /// A system that runs once, before all others.
  void begin_with(const std::string& system) { first_.push_back(make(system)); }
  /// One more standing step, behind those that are there.
  void add_standing_step(const std::string& configure, std::vector<System> after);
  /// A system that runs at every output time.
  void add_output(const std::string& system) { output_.push_back(make(system)); }

  /// Calls `seed` before the first step; seeds are called in the order in which they were added.
  void seed(Seed seed) { seeds_.push_back(std::move(seed)); }
  /// Seeds a resource.
  template <ResourceComponent C>
  void constant(C value) {
    seed([value = std::move(value)](const Scene&, World& world, SeedProblems&) { world.resource<C>() = value; });
  }

  /// A registered system in the dimension of the scene, without options.
  System make(const std::string& system) const { return registry_->make(system, dimension_); }
  /// What can be named.
  const SystemRegistry& registry() const { return *registry_; }

  /// What add() has added, in its order.
  const std::vector<Placed>& placed() const { return placed_; }
  /// What begin_with() has added.
  const std::vector<System>& first() const { return first_; }
  /// What add_standing_step() has added.
  const std::vector<StandingStep>& standing_steps() const { return standing_; }
  /// What add_output() has added.
  const std::vector<System>& output() const { return output_; }
  /// What seed() and constant() have added.
  const std::vector<Seed>& seeds() const { return seeds_; }

 private:
  const SystemRegistry* registry_ = nullptr;
  int dimension_ = 2;
  std::map<std::string, Maker> makers_;
  std::vector<Placed> placed_;
  std::vector<System> first_;
  std::vector<StandingStep> standing_;
  std::vector<System> output_;
  std::vector<Seed> seeds_;
};

/// What a part does once all parts have read their keys, in the order of the parts.
using Contribution = std::function<void(const Scene&, Recipe&)>;

/// A key of scenes and what comes of it. Register it: `registry.add(Part{"wind", "drag of the air", read_wind})`.
struct Part {
  std::string name = {};  ///< its key in the scene
  std::string doc = {};   ///< one line
  /// Reads its key and leaves in the scene what other parts ask for (Scene::facts). \return what it adds; may be empty
  std::function<Contribution(Input&, Scene&)> read = {};
  std::function<std::vector<std::pair<std::string, std::string>>(const SystemRegistry&)> schemes =
      {};  ///< name and doc of what can be chosen; empty where there is no choice
};

/// One way to do what a part does, chosen by its name. Every choice derives a type of its own from it.
struct Scheme {
  std::string name;  ///< as in the scene
  std::string doc;   ///< one line
  /// Reads its options next to `scheme`. May be empty: no options, and nothing to add.
  std::function<Contribution(Input&, Scene&)> read;
};

/// Name and doc of all registered schemes of a type.
template <class SchemeType>
std::vector<std::pair<std::string, std::string>> schemes_of(const SystemRegistry& registry) {
  std::vector<std::pair<std::string, std::string>> schemes;
  for (const auto& [name, scheme] : registry.choices<SchemeType>()) schemes.emplace_back(name, scheme.doc);
  return schemes;
}

/// The scheme of a scene that names none.
struct DefaultScheme {
  std::function<std::string(const Input&, const Scene&)> of;  ///< may depend on what else stands in the scene
  std::string other = {};  ///< which one it is when, if not always the same; a phrase
};
/// The same scheme whatever stands in the scene.
inline DefaultScheme always(const std::string& scheme) {
  return {[scheme](const Input&, const Scene&) { return scheme; }};
}

/// A part whose key holds `scheme`, the name of a registered scheme, and its options.
/// \param read  of a scheme
template <class SchemeType>
Part choice(const std::string& key, const std::string& doc, const DefaultScheme& fallback,
            const std::function<Contribution(const SchemeType&, Input&, Scene&)>& read);

/// The same for schemes that read themselves.
template <class SchemeType>
Part choice(const std::string& key, const std::string& doc, const DefaultScheme& fallback) {
  return choice<SchemeType>(key, doc, fallback, [](const SchemeType& scheme, Input& input, Scene& scene) {
    return scheme.read ? scheme.read(input, scene) : Contribution{};
  });
}

/// What the scene can name.
const SystemRegistry& registry_of(const Scene& scene);
/// Puts down which scheme of a part the scene has, for Scene::schemes.
void note_scheme(Scene& scene, const std::string& part, const std::string& scheme);

template <class SchemeType>
Part choice(const std::string& key, const std::string& doc, const DefaultScheme& fallback,
            const std::function<Contribution(const SchemeType&, Input&, Scene&)>& read) {
  const auto read_part = [key, doc, fallback, read](Input& input, Scene& scene) {
    Contribution contribution;
    Input::Variants variants;
    for (const auto& [name, scheme] : registry_of(scene).template choices<SchemeType>()) {
      variants.emplace_back(name, [&, &scheme = scheme](Input& in) { contribution = read(scheme, in, scene); });
    }
    const std::string unless_named = fallback.of(input, scene);
    const std::string meaning = fallback.other.empty() ? doc : doc + "; by default " + fallback.other;
    input.object(key, doc, Input::Presence::optional,
                 [&](Input& in) { note_scheme(scene, key, in.variant("scheme", meaning, unless_named, variants)); });
    return contribution;
  };
  return {key, doc, read_part, schemes_of<SchemeType>};
}

}  // namespace minamo
