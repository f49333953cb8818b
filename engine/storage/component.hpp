#pragma once
/// \file
/// What a component is: a column of a table or a resource, with a name, a symbol, a unit and a lifetime.
/// Where components are stored: world.hpp. Who may touch them: system.hpp.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace minamo {

/// How long the content of a component means something.
enum class Lifetime {
  constant,  ///< written while the run is set up, only read afterwards
  state,     ///< carried from step to step; the checkpoint is made of these
  scratch,   ///< written anew in every step before it is read
  cache,     ///< kept between steps to save work; no result depends on it
};

/// What a component says of itself, as `static constexpr ComponentInfo info`. From it come the checks of the schedule,
/// checkpoints, `minamo list components` and the graph of a scene.
struct ComponentInfo {
  std::string_view name;    ///< unique, `table.quantity`
  std::string_view symbol;  ///< as in systems/EQUATIONS.md
  std::string_view unit;    ///< SI; "1" is dimensionless
  Lifetime lifetime;        ///< how long its content means something
};

/// Base of a column component: one `Value` per row of `Table`. A table is an empty struct with a `name`.
template <class Table, class Value>
struct Column {
  using table = Table;       ///< whose rows it has
  using value_type = Value;  ///< what a row has of it
};

template <class C>
concept Described = requires {
  { C::info } -> std::convertible_to<const ComponentInfo&>;
};

template <class C>
concept ColumnComponent = Described<C> && requires {
  typename C::table;
  typename C::value_type;
};

/// One value per world, of the component's own type. What it holds for the rows of a table means nothing any more when
/// that table is resized: `using rows_of = Table;` says so to the schedule.
template <class C>
concept ResourceComponent = Described<C> && !ColumnComponent<C> && std::default_initializable<C>;

/// A zero of any value type. `T{}` of a fixed-size matrix type would stay uninitialised.
template <class T>
T zero() {
  if constexpr (requires { T::Zero(); }) {
    return T::Zero();
  } else {
    return T{};
  }
}

namespace detail {
/// 0, 1, 2, ...
std::size_t next_component_id();
}  // namespace detail

}  // namespace minamo
