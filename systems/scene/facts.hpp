#pragma once
/// \file
/// What the parts of a scene have read and other parts ask for, one value per type.

#include <any>
#include <map>
#include <stdexcept>
#include <string>
#include <typeindex>
#include <typeinfo>

namespace minamo {

/// One value per type, kept by that type: a part sets `MyFact`, another one gets it.
class Facts {
 public:
  /// Keeps it, in place of one of that type.
  template <class Fact>
  void set(Fact fact) {
    facts_.insert_or_assign(typeid(Fact), std::move(fact));
  }
  /// Null if no part has set it.
  template <class Fact>
  const Fact* find() const {
    const auto found = facts_.find(typeid(Fact));
    return found == facts_.end() ? nullptr : &std::any_cast<const Fact&>(found->second);
  }
  /// \throws std::logic_error if no part has set it.
  template <class Fact>
  const Fact& get() const {
    if (const Fact* fact = find<Fact>()) return *fact;
    throw std::logic_error(std::string("no part of the scene tells of ") + typeid(Fact).name());
  }

 private:
  std::map<std::type_index, std::any> facts_;
};

}  // namespace minamo
