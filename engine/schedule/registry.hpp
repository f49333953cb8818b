#pragma once
/// \file
/// What scenes choose by name: systems, for two and three dimensions at once, and whatever else is added as a type of
/// its own. Registration is explicit: systems/step/register.cpp lists what is built in, a program that links minamo
/// adds its own.

#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"

#include <any>
#include <map>
#include <stdexcept>
#include <typeindex>

namespace minamo {

/// What a scene can name. A program that links minamo gets it in the callback of run():
///
/// \code
/// minamo::run(argc, argv, [](SystemRegistry& registry) { registry.add<MeasureMeanHeight>("mean_height"); });
/// \endcode
class SystemRegistry {
 public:
  /// What `minamo list systems` shows of a system.
  struct Entry {
    std::string name;  ///< by which scenes name it
    std::string doc;   ///< `Kernel::doc` where it has one: one line, with the equation's number
    std::string file;  ///< that declares the kernel, from systems/ on; empty of those that are declared elsewhere
    /// A kernel of one dimension.
    struct Kernel {
      const detail::Erased* system;                         ///< its declaration, and how it is called
      std::shared_ptr<const void> (*make)(Input* options);  ///< null if it has neither members nor options
    };
    Kernel plane;                             ///< `Kernel<2>`
    Kernel space;                             ///< `Kernel<3>`
    OnRanks on_ranks = OnRanks::one_process;  ///< what it does where a run is spread over ranks
    /// \param options  may be null: no options given
    System make(int dimension, Input* options) const;
  };

  /// Registers `Kernel<2>` and `Kernel<3>`. A kernel with a constructor from `Input&` reads its options there.
  /// \param on_ranks  runs on several ranks are refused what is not made for them
  /// \throws std::logic_error if the name is taken.
  template <template <int> class Kernel>
  void add(std::string_view name, OnRanks on_ranks = OnRanks::one_process) {
    Doc doc{std::string_view()};
    if constexpr (requires { Kernel<2>::doc; }) doc = Doc(Kernel<2>::doc);
    insert(
        {std::string(name), std::string(doc.text), file_of(doc), erased<Kernel<2>>(), erased<Kernel<3>>(), on_ranks});
  }

  /// Adds something that is chosen by its member `name`, like a transfer scheme.
  /// \throws std::logic_error if another one of this type has the name.
  template <class Choice>
  void add(Choice choice) {
    std::any& all = choices_.try_emplace(typeid(Choice), Registered<Choice>()).first->second;
    auto& [named, in_order] = std::any_cast<Registered<Choice>&>(all);
    const auto [position, is_new] = named.try_emplace(choice.name, choice);
    if (!is_new) throw std::logic_error("\"" + position->first + "\" is registered twice");
    in_order.push_back(std::move(choice));
  }
  /// Choices of a type by their names.
  template <class Choice>
  using Named = std::map<std::string, Choice, std::less<>>;
  /// All choices of a type.
  template <class Choice>
  const Named<Choice>& choices() const {
    return registered<Choice>().named;
  }
  /// As they were added.
  template <class Choice>
  const std::vector<Choice>& in_order() const {
    return registered<Choice>().in_order;
  }

  /// Whether a system has this name.
  bool contains(std::string_view name) const { return entries_.contains(name); }

  /// \pre `dimension` is 2 or 3.
  /// \throws std::out_of_range for an unknown name, with the known ones and the closest.
  System make(std::string_view name, int dimension, Input* options = nullptr) const;

  /// The names of all systems.
  std::vector<std::string> names() const;
  /// All systems by name.
  const std::map<std::string, Entry, std::less<>>& entries() const { return entries_; }

 private:
  template <class Choice>
  struct Registered {
    Named<Choice> named;
    std::vector<Choice> in_order;
  };
  template <class Choice>
  const Registered<Choice>& registered() const {
    static const Registered<Choice> none;
    const auto found = choices_.find(typeid(Choice));
    return found == choices_.end() ? none : std::any_cast<const Registered<Choice>&>(found->second);
  }

  template <class Kernel>
  static constexpr Entry::Kernel erased() {
    if constexpr (std::is_empty_v<Kernel> && !std::is_constructible_v<Kernel, Input&>) {
      return {&detail::Declared<Kernel>::erased, nullptr};
    } else {
      return {&detail::Declared<Kernel>::erased, &make_kernel<Kernel>};
    }
  }
  template <class Kernel>
  static std::shared_ptr<const void> make_kernel(Input* options) {
    if constexpr (std::is_constructible_v<Kernel, Input&>) {
      if (options) return detail::owned(new Kernel(*options));
    }
    (void)options;
    return detail::owned(new Kernel());
  }
  void insert(Entry entry);
  static std::string file_of(const Doc& doc);

  std::map<std::string, Entry, std::less<>> entries_;
  std::map<std::type_index, std::any> choices_;  ///< Registered<Choice> per type
};

}  // namespace minamo
