#pragma once
/// \file
/// Parameters of systems that come in families: a bundle is a struct of views, and stands for all of them.
///
/// \code
/// struct HeightAndTotal {
///   Read<Height> h;
///   Update<Total> T;
/// };
/// void operator()(Uses<HeightAndTotal> of, Write<Slope> s) const;  // of.h[row], *of.T
/// \endcode

#include "engine/storage/world.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace minamo {

/// Names of optional components that no system of a list writes.
using Absent = std::vector<std::string_view>;

namespace detail {

/// A parameter of a system, made by the schedule.
template <class View>
View view(World& world, const Absent& absent) {
  if constexpr (std::is_constructible_v<View, World&, const Absent&>) {
    return View(world, absent);
  } else {
    return View(world);
  }
}

/// What every member of a bundle is made from.
struct AnyView {
  World* world;
  const Absent* absent;
  template <class View>
  operator View() const {  // NOLINT(google-explicit-constructor): members are initialized by it
    return view<View>(*world, *absent);
  }
};

inline constexpr std::size_t most_members = 8;

template <class Bundle, std::size_t... Index>
constexpr bool has_members(std::index_sequence<Index...>) {
  return requires { Bundle{(static_cast<void>(Index), std::declval<AnyView>())...}; };
}
/// How many views a bundle is made of.
template <class Bundle, std::size_t N = most_members>
constexpr std::size_t members_of() {
  if constexpr (N == 0 || has_members<Bundle>(std::make_index_sequence<N>())) {
    return N;
  } else {
    return members_of<Bundle, N - 1>();
  }
}

template <class... Views>
struct TypeList {};

/// Only its type is asked for.
template <class Bundle>
constexpr auto types_of_members(Bundle& bundle) {
  constexpr std::size_t N = members_of<Bundle>();
  static_assert(N > 1, "a bundle has two to eight views");
  if constexpr (N == 2) {
    auto& [a, b] = bundle;
    return TypeList<decltype(a), decltype(b)>{};
  } else if constexpr (N == 3) {
    auto& [a, b, c] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c)>{};
  } else if constexpr (N == 4) {
    auto& [a, b, c, d] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c), decltype(d)>{};
  } else if constexpr (N == 5) {
    auto& [a, b, c, d, e] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e)>{};
  } else if constexpr (N == 6) {
    auto& [a, b, c, d, e, f] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f)>{};
  } else if constexpr (N == 7) {
    auto& [a, b, c, d, e, f, g] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g)>{};
  } else {
    auto& [a, b, c, d, e, f, g, h] = bundle;
    return TypeList<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g),
                    decltype(h)>{};
  }
}

}  // namespace detail

/// Parameter of a system that stands for all views of a bundle, which are its members.
template <class Bundle>
struct Uses : Bundle {
  /// The schedule makes it.
  Uses(World& world, const Absent& absent)
      : Uses(detail::AnyView{&world, &absent}, std::make_index_sequence<detail::members_of<Bundle>()>()) {}

 private:
  template <std::size_t... Index>
  Uses(const detail::AnyView& any, std::index_sequence<Index...>) : Bundle{(static_cast<void>(Index), any)...} {}
};

}  // namespace minamo
