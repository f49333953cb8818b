#pragma once
/// \file
/// A system is a struct whose `operator()` parameters are its declaration: `Read<C>`, `Optional<Read<C>>`, `Write<C>`,
/// `Update<C>`, `RowBytes<Table>`, `Resize<Table>`, and `Uses<Bundle>` for several of them. make_system() turns it into
/// what the schedule runs. It cannot touch what it did not declare.

#include "engine/schedule/doc.hpp"
#include "engine/schedule/parallel.hpp"
#include "engine/schedule/uses.hpp"
#include "engine/storage/world.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace minamo {

/// What a system does with a component.
enum class Mode {
  read,    ///< looks at it
  write,   ///< every row is given a new value; the old ones are not looked at
  update,  ///< reads and writes
  rows,    ///< reads and writes what outlives a step in rows of a table, whatever columns there are
  resize,  ///< changes the rows of a table: all its columns are touched, its scratch becomes stale
};

/// Whether that is of all columns of a table, not of a component.
constexpr bool is_of_table(Mode mode) { return mode == Mode::rows || mode == Mode::resize; }

/// One line of a system's declaration.
struct Access {
  Mode mode;                   ///< what it does
  std::string_view component;  ///< empty if is_of_table(mode)
  std::string_view table;      ///< whose rows it has or, as a resource, belongs to; empty for other resources
  const ComponentInfo* info;   ///< null if is_of_table(mode)
  bool optional = false;       ///< a read of what need not be there
  const detail::ComponentType* type = nullptr;  ///< from which a world makes it; null if is_of_table(mode)
};

namespace detail {

template <Described C>
constexpr Access access_to(Mode mode) {
  if constexpr (ColumnComponent<C>) {
    return {mode, C::info.name, C::table::name, &C::info, false, &component_type<C>};
  } else if constexpr (requires { typename C::rows_of; }) {
    return {mode, C::info.name, C::rows_of::name, &C::info, false, &component_type<C>};
  } else {
    return {mode, C::info.name, {}, &C::info, false, &component_type<C>};
  }
}

/// A column as a system sees it; `Value` is const for a reader. It follows its table when that is resized.
template <class C, class Value, Mode mode>
class ColumnView {
 public:
  explicit ColumnView(World& world) : storage_(&world.storage<C>()) {
    if constexpr (mode == Mode::write) storage_->keep(Old::unread);
    if constexpr (mode == Mode::update) storage_->keep(Old::needed);
  }
  static constexpr Access access() { return access_to<C>(mode); }
  Value& operator[](std::size_t row) const { return storage_->values()[row]; }
  std::size_t size() const { return storage_->rows(); }
  auto begin() const { return span().begin(); }
  auto end() const { return span().end(); }
  std::span<Value> span() const { return storage_->values(); }

 private:
  ColumnStorage<typename C::value_type>* storage_;
};

/// A resource as a system sees it.
template <class C, class Value, Mode mode>
class ResourceView {
 public:
  explicit ResourceView(World& world) : value_(&world.resource<C>()) {}
  static constexpr Access access() { return access_to<C>(mode); }
  Value& operator*() const { return *value_; }
  Value* operator->() const { return value_; }

 private:
  Value* value_;
};

template <class C, Mode mode>
struct View {
  using type = ResourceView<C, std::conditional_t<mode == Mode::read, const C, C>, mode>;
};
template <ColumnComponent C, Mode mode>
struct View<C, mode> {
  using T = typename C::value_type;
  using type = ColumnView<C, std::conditional_t<mode == Mode::read, const T, T>, mode>;
};

}  // namespace detail

/// Parameter of a system that looks at the component C and does not change it.
///
/// Of a column: `x[row]`, `x.size()`, `x.span()`, `for (auto& value : x)`. Of a resource: `*x`, `x->member`.
template <Described C>
struct Read : detail::View<C, Mode::read>::type {
  /// The schedule makes it.
  explicit Read(World& world) : detail::View<C, Mode::read>::type(world) {}
};

/// Parameter of a system that gives every row of C a new value, or the resource C a new content. It does not look at
/// the old ones, which may be any. Members as of Read, values not const. Whoever reads C later in the step sees the new
/// values.
template <Described C>
struct Write : detail::View<C, Mode::write>::type {
  /// The schedule makes it.
  explicit Write(World& world) : detail::View<C, Mode::write>::type(world) {}
};

/// Parameter of a system that looks at C and changes it, like a force that adds to face::BodyForce. Members as of Read,
/// values not const.
template <Described C>
struct Update : detail::View<C, Mode::update>::type {
  /// The schedule makes it.
  explicit Update(World& world) : detail::View<C, Mode::update>::type(world) {}
};

/// Reads a component that exists only if the scene has it: a scratch component is there if an earlier system of the
/// list writes it, any other if the world has it. It is not created for the sake of a reader.
template <class Reader>
class Optional;

/// Parameter of a system that looks at C where there is one: `if (x) use(x[row]);`.
template <Described C>
class Optional<Read<C>> {
 public:
  /// The schedule makes it.
  Optional(World& world, const Absent& absent) {
    const bool is_absent = std::find(absent.begin(), absent.end(), C::info.name) != absent.end();
    if (!is_absent && world.has<C>()) view_.emplace(world);
  }
  /// Its line in the declaration of the system.
  static constexpr Access access() {
    Access access = Read<C>::access();
    access.optional = true;
    return access;
  }
  /// Whether it is there.
  explicit operator bool() const { return view_.has_value(); }
  /// \pre it is there.
  decltype(auto) operator*() const requires(!ColumnComponent<C>) { return **view_; }
  /// \pre it is there.
  auto operator->() const requires(!ColumnComponent<C>) { return view_->operator->(); }
  /// \pre it is there.
  decltype(auto) operator[](std::size_t row) const requires ColumnComponent<C> { return (*view_)[row]; }
  /// Empty where the component is not there.
  auto span() const requires ColumnComponent<C> { return view_ ? view_->span() : decltype(view_->span()){}; }

 private:
  std::optional<Read<C>> view_;
};

/// The rows of a table as bytes, with all columns that outlive a step.
template <class Table>
class RowBytes {
 public:
  /// The schedule makes it.
  explicit RowBytes(World& world) : world_(&world) { world.add_table<Table>(); }
  /// Its line in the declaration of the system.
  static constexpr Access access() { return {Mode::rows, {}, Table::name, nullptr}; }
  /// Rows as bytes, one after the other (world.hpp).
  std::vector<std::byte> pack(std::span<const std::uint32_t> rows) const { return world_->pack(Table::name, rows); }
  /// Bytes of a row that is packed.
  std::size_t packed_bytes() const { return world_->packed_bytes(Table::name); }
  /// Rows become what pack() has packed of as many.
  void unpack(std::span<const std::uint32_t> rows, std::span<const std::byte> packed) const {
    world_->unpack(Table::name, rows, packed);
  }

 private:
  World* world_;
};

/// The right to change the rows of a table.
/// Views of its columns follow; spans taken from them before do not.
template <class Table>
class Resize {
 public:
  /// The schedule makes it.
  explicit Resize(World& world) : world_(&world) { world.add_table<Table>(); }
  /// Its line in the declaration of the system.
  static constexpr Access access() { return {Mode::resize, {}, Table::name, nullptr}; }
  /// How many there are.
  std::size_t rows() const { return world_->rows<Table>(); }
  /// As many rows as that; new ones are zero.
  void resize(std::size_t rows) const { world_->resize<Table>(rows); }
  /// Row k becomes what row `order[k]` was.
  void reorder(std::span<const std::uint32_t> order) const { world_->reorder<Table>(order); }
  /// As many rows as entries; row k becomes what row `from[k]` was, or zero if there is none.
  void renumber(std::span<const std::optional<std::uint32_t>> from) const { world_->renumber<Table>(from); }
  /// Rows as bytes, and more of them, from a world with the same columns (world.hpp).
  std::vector<std::byte> pack(std::span<const std::uint32_t> rows) const { return world_->pack(Table::name, rows); }
  /// Adds what pack() has packed.
  void append(std::span<const std::byte> packed) const { world_->append(Table::name, packed); }

 private:
  World* world_;
};

/// What a system does where a run is spread over ranks. Said where it is registered, since it has to be made for it.
enum class OnRanks {
  one_process,        ///< knows nothing of other ranks, and needs what they have
  own,                ///< looks at what its rank has alone
  adds_up,            ///< sums over what ranks share, or over all
  exchanges,          ///< sends what it needs
  alike_on_all,       ///< every rank does the same
  first_rank_writes,  ///< files
};
/// As lists of systems show it.
std::string_view name_of(OnRanks on_ranks);

/// What the schedule runs.
struct System {
  std::string name;                                   ///< of its row in the profile
  std::vector<Access> access;                         ///< its declaration
  std::function<void(World&)> prepare;                ///< creates the components; called once, before anything runs
  std::function<void(World&)> run;                    ///< calls it once
  std::function<System(const Absent&)> without = {};  ///< the same where optional components are absent
  std::vector<System> body = {};                      ///< of a loop (loop.hpp)
  std::function<bool(World&, int pass)> again = {};  ///< of a loop: whether its body is to run for this pass, 0, 1, ...
  OnRanks on_ranks = OnRanks::one_process;           ///< that of its registration; a loop is fit if all of its body is
};

namespace detail {

/// The lines of a parameter in a declaration.
template <class Arg>
struct Lines {
  static constexpr std::array<Access, 1> access{Arg::access()};
};
template <class... Views>
struct Lines<TypeList<Views...>> {
  static constexpr std::array<Access, sizeof...(Views)> access{Views::access()...};
};
template <class Bundle>
struct Lines<Uses<Bundle>> : Lines<decltype(types_of_members(std::declval<Bundle&>()))> {};

/// A system without its types: all that is compiled for each is its declaration and `run`.
struct Erased {
  std::span<const Access> access;
  void (*run)(const void* kernel, World& world, const Absent& absent);
};
/// \param kernel  made with new; a deleter of one type for all is compiled once
template <class Kernel>
std::shared_ptr<const void> owned(const Kernel* kernel) {
  return {static_cast<const void*>(kernel), +[](const void* one) { delete static_cast<const Kernel*>(one); }};
}

/// \param kernel  may be null if it has no members
System make_system(std::string name, const Erased& erased, std::shared_ptr<const void> kernel);

template <class Kernel, class Call = decltype(&Kernel::operator())>
struct Declared;
template <class Kernel, class... Args>
struct Declared<Kernel, void (Kernel::*)(Args...) const> {
  static void run(const void* kernel, World& world, const Absent& absent) {
    if constexpr (std::is_empty_v<Kernel>) {
      Kernel{}(view<Args>(world, absent)...);
    } else {
      (*static_cast<const Kernel*>(kernel))(view<Args>(world, absent)...);
    }
  }
  static constexpr auto all_lines() {
    std::array<Access, (Lines<Args>::access.size() + ... + 0)> all{};
    auto* next = all.data();
    ((next = std::copy(Lines<Args>::access.begin(), Lines<Args>::access.end(), next)), ...);
    return all;
  }
  static constexpr auto access = all_lines();
  static constexpr Erased erased{access, &run};
};

}  // namespace detail

/// \pre `Kernel` has one `operator()(...) const` whose parameters are Read, Optional, Write, Update, RowBytes, Resize
/// or Uses.
template <class Kernel>
System make_system(std::string name, Kernel kernel = {}) {
  std::shared_ptr<const void> members;
  if constexpr (!std::is_empty_v<Kernel>) members = detail::owned(new Kernel(std::move(kernel)));
  return detail::make_system(std::move(name), detail::Declared<Kernel>::erased, std::move(members));
}

}  // namespace minamo
