#pragma once
// Particle state as a structure of arrays, and the one table of its columns.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "poreshock/core/tensor.hpp"

namespace poreshock {

/// Which optional columns a scene needs; columns it does not need stay empty.
struct ParticleOptions {
  bool affine = true;           ///< transfers with affine modes
  bool quadratic = false;       ///< transfers with modes of second order
  bool back_stress = false;     ///< kinematic hardening
  bool conducted_heat = false;  ///< heat conduction in paper mode
  bool failed = false;          ///< some material has a spall strength
  bool facing = false;          ///< self-contact

  bool operator==(const ParticleOptions&) const = default;
};

/// What the update of the stress does with a column.
enum class InStress { unused, read, changed };

/// What else is known about a column.
struct ColumnUse {
  bool shown = false;  ///< snapshots hold it as it is
  InStress stress = InStress::unused;
  bool ParticleOptions::*option = nullptr;  ///< without it the column is there only if this is set
};

/// One column or one per component: all that is known about it. `Member` points to it.
template <class Member>
struct Column {
  std::string_view name;
  std::string_view unit;
  Member member;
  ColumnUse use;
};

template <class Member>
constexpr Column<Member> column(std::string_view name, std::string_view unit, Member member,
                                ColumnUse use = {}) {
  return {name, unit, member, use};
}

/// Columns of particles, each a Store. The table `columns` tells all about each; resizing,
/// reordering, migration, checkpoints, checks, snapshots and the stress update follow from it.
template <int Dim, template <class> class Store>
struct ParticleColumns {
  ParticleOptions options;
  Store<std::int64_t> id;  ///< from the sample, unique, never changes
  Store<std::int32_t> grain;
  Store<std::int32_t> material;             ///< index into the scene's materials
  std::array<Store<double>, Dim> position;  ///< relative to the grid origin
  std::array<Store<double>, Dim> velocity;
  std::array<Store<double>, Dim * Dim> affine;  ///< row major, velocity gradient of its own
  /// Amplitudes of r_a r_b for each component, of norm 1 under N; see second_modes.
  std::array<Store<double>, Dim * second_modes<Dim>> quadratic;
  Store<double> mass;  ///< per metre of depth in plane strain
  Store<double> density;
  Store<double> pressure;          ///< equation of state, compression positive
  Store<double> viscous_pressure;  ///< artificial viscosity q >= 0
  Store<double> internal_energy;
  Store<double> plastic_strain;
  Store<double> plastic_work;                               ///< the part that is heat
  std::array<Store<double>, symmetric_size<Dim>> deviator;  ///< tension positive
  std::array<Store<double>, symmetric_size<Dim>> back_stress;
  Store<double> conducted_heat;  ///< received by conduction; part of internal_energy
  Store<std::int32_t> failed;    ///< 1, or less than 0 while it opens at its strength
  /// Unit vector out of the material towards the surface it is nearest to; 0 far from all.
  std::array<Store<double>, Dim> facing;

  std::size_t size() const { return id.size(); }

  /// Names and order are the checkpoint format; an option's flag stands there under the name.
  static constexpr auto columns() {
    using C = ParticleColumns;
    using O = ParticleOptions;
    constexpr InStress unused = InStress::unused, read = InStress::read;
    constexpr InStress changed = InStress::changed;
    return std::make_tuple(
        column("id", "1", &C::id, {true}), column("grain", "1", &C::grain, {true}),
        column("material", "1", &C::material, {true}), column("position", "m", &C::position),
        column("velocity", "m/s", &C::velocity, {true, read}),
        column("affine", "1/s", &C::affine, {false, unused, &O::affine}),
        column("quadratic", "m/s", &C::quadratic, {false, unused, &O::quadratic}),
        column("mass", Dim == 2 ? "kg/m" : "kg", &C::mass, {true, read}),
        column("density", "kg/m^3", &C::density, {true, changed}),
        column("pressure", "Pa", &C::pressure, {true, changed}),
        column("viscous_pressure", "Pa", &C::viscous_pressure, {false, changed}),
        column("internal_energy", "J/kg", &C::internal_energy, {true, changed}),
        column("plastic_strain", "1", &C::plastic_strain, {true, changed}),
        column("plastic_work", "J/kg", &C::plastic_work, {true, changed}),
        column("deviator", "Pa", &C::deviator, {false, changed}),
        column("back_stress", "Pa", &C::back_stress, {false, changed, &O::back_stress}),
        column("conducted_heat", "J/kg", &C::conducted_heat, {true, unused, &O::conducted_heat}),
        column("failed", "1", &C::failed, {true, changed, &O::failed}),
        column("facing", "1", &C::facing, {false, unused, &O::facing}));
  }
};

template <class T>
using ColumnVector = std::vector<T>;
template <class T>
using ColumnPointer = T*;

/// State of the particles of one rank. All columns have the same length, but those not in use: 0.
template <int Dim>
using Particles = ParticleColumns<Dim, ColumnVector>;

/// The same particles in place, or copies of some of them; null where a column is not in use.
template <int Dim>
using ParticlePointers = ParticleColumns<Dim, ColumnPointer>;

/// Calls visit(column, member of first, member of the others ...) for every entry of the table that
/// is in use in `first`, always in the same order. A member is one column or an array of them.
template <class Visitor, class First, class... Others>
void for_each_entry(Visitor&& visit, First& first, Others&... others) {
  const auto at = [&]<std::size_t I>() {
    constexpr auto entry = std::get<I>(First::columns());
    if (entry.use.option != nullptr && !(first.options.*entry.use.option)) return;
    visit(entry, first.*entry.member, others.*std::get<I>(Others::columns()).member...);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (at.template operator()<I>(), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(First::columns())>>{});
}

/// True for a member that is an array of columns.
template <class Member>
inline constexpr bool has_components = false;
template <class Store, std::size_t Count>
inline constexpr bool has_components<std::array<Store, Count>> = true;

/// Calls visit(component, column of the first member, of the others ...) for each column of a
/// member, of several particles at once; `component` is -1 where there is one column.
template <class Visitor, class Member, class... Members>
void for_each_component(Visitor&& visit, Member& member, Members&... others) {
  if constexpr (has_components<std::remove_const_t<Member>>) {
    for (std::size_t c = 0; c < member.size(); ++c) {
      visit(static_cast<int>(c), member[c], others[c]...);
    }
  } else {
    visit(-1, member, others...);
  }
}

/// Calls visit(name, component, column) for every column in use, always in the same order.
/// `component` is -1 for scalars.
template <class ParticlesType, class Visitor>
void for_each_column(ParticlesType& particles, Visitor&& visit) {
  for_each_entry(
      [&](const auto& entry, auto& member) {
        for_each_component([&](int c, auto& column) { visit(entry.name, c, column); }, member);
      },
      particles);
}

/// Calls visit(name, flag) for every optional column, in use or not.
template <class Options, class Visitor>
void for_each_option(Options& options, Visitor&& visit) {
  const auto one = [&](const auto& entry) {
    if (entry.use.option != nullptr) visit(entry.name, options.*entry.use.option);
  };
  std::apply([&](const auto&... entry) { (one(entry), ...); }, Particles<2>::columns());
}

/// Sets the number of particles; new ones are zero. Not collective.
template <int Dim>
void resize(Particles<Dim>& particles, std::size_t count);

/// Gives back memory that the columns hold beyond their length.
template <int Dim>
void release_spare(Particles<Dim>& particles);

/// Reorders all columns: new particle first + k is the old particle order[k]. A shorter order drops
/// the rest.
template <int Dim>
void reorder(const std::vector<std::uint32_t>& order, Particles<Dim>& particles,
             std::size_t first = 0);

/// Bytes one particle takes in all columns in use.
template <int Dim>
std::size_t bytes_per_particle(const Particles<Dim>& particles);

/// Appends particles of `source` at `indices` to a byte buffer, column after column. Not
/// collective.
template <int Dim>
void pack(const Particles<Dim>& source, const std::vector<std::uint32_t>& indices,
          std::vector<std::byte>& buffer);

/// Appends the `count` particles packed by pack() to `particles`. Not collective.
template <int Dim>
void unpack(const std::byte* buffer, std::size_t count, Particles<Dim>& particles);

/// Appends particles of `source` at `indices` to `target`, which has the same columns. Not
/// collective.
template <int Dim>
void append(const Particles<Dim>& source, const std::vector<std::uint32_t>& indices,
            Particles<Dim>& target);

/// Squares of what the modes of particle p beyond its velocity add to its kinetic energy, for each
/// component, m^2/s^2; `inertia` of affine_inertia.
template <int Dim>
std::array<double, Dim> mode_squares(const Particles<Dim>& particles, double inertia,
                                     std::size_t p);

/// Kinetic energy of particle p with all its modes, J/kg.
template <int Dim>
double kinetic_energy(const Particles<Dim>& particles, double inertia, std::size_t p);

}  // namespace poreshock
