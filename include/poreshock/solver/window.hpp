#pragma once
// A domain that follows the front through a higher sample. Rows and heights keep the numbers that
// they would have in a domain of the whole sample, so that all arithmetic is the same there.

#include <cstdint>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Which part of the sample has particles.
struct Window {
  int first = 0;                ///< lowest row of the domain
  std::int64_t strips = 0;      ///< handed over so far
  std::int64_t next = 0;        ///< lowest layer of lattice sites that has no particles yet
  std::vector<double> heights;  ///< m on the grid, of the layers from `next` on
};

template <int Dim>
struct Simulation;

/// Least and most rows of a strip that is handed over at once; `step` between, so that they are
/// whole pixels.
struct StripHeights {
  int first, last, step;
};
StripHeights strip_heights(const Scene& scene);

/// The window at the start; without time.follow all layers have particles.
Window open_window(const Scene& scene);

/// Shape of the grid where the window is now.
template <int Dim>
GridShape window_shape(const Simulation<Dim>& sim);

/// Moves the layers above the window over dt, as sleeping particles move. Not collective.
template <int Dim>
void move_layers(double dt, Simulation<Dim>& sim);

/// True when a wave comes so near the top of the window that the next step may need rows above it.
/// The same on all ranks after agree_on_step. Not collective.
template <int Dim>
bool must_hand_over(const Simulation<Dim>& sim);

/// Rows of the strip that is handed over next: particles go as a whole, and here the volumes that
/// so cross its upper end one way and the other come nearest to each other. Collective.
template <int Dim>
int best_strip(const Simulation<Dim>& sim);

/// Particles of this rank in the lowest rows, by their places in storage. Not collective.
template <int Dim>
std::vector<std::uint32_t> strip_particles(int rows, const Simulation<Dim>& sim);

/// Books and removes the lowest rows; the plane at the low side moves up to where they ended.
/// Collective.
template <int Dim>
void hand_over(int rows, Simulation<Dim>& sim);

/// Makes the particles of all layers that have come into the window, and books them. Not
/// collective.
template <int Dim>
void take_in(Simulation<Dim>& sim);

/// Hands over and takes in until the next step has all rows that it needs. Collective.
template <int Dim>
void follow_front(Simulation<Dim>& sim);

/// The window as integers, for a checkpoint.
std::vector<std::int64_t> save(const Window& window);

/// What save() gave. Throws std::out_of_range where words are missing.
Window window_of(const std::vector<std::int64_t>& words);

}  // namespace poreshock
