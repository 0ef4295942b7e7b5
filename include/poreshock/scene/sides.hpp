#pragma once
// Sides of the domain: what each kind does with material, told once. All others ask.

#include <array>
#include <string>
#include <string_view>

namespace poreshock {

enum class SideKind { wall, free, symmetry, periodic };

/// What a side does.
struct SideLaw {
  SideKind kind;
  std::string_view name;  ///< in a scene
  bool mirrors = false;   ///< a plane that stops material: what lies beyond mirrors the inside
  bool holds = false;     ///< such a plane pulls as well as it pushes
  bool drives = false;    ///< has a velocity and friction
  bool lets_out = false;  ///< material beyond it is gone; else it is put back
  bool wraps = false;     ///< material beyond it comes in at the other side
};

inline constexpr std::array<SideLaw, 4> side_laws = {{
    {.kind = SideKind::wall, .name = "wall", .mirrors = true, .drives = true},
    {.kind = SideKind::free, .name = "free", .lets_out = true},
    {.kind = SideKind::symmetry, .name = "symmetry", .mirrors = true, .holds = true},
    {.kind = SideKind::periodic, .name = "periodic", .wraps = true},
}};

constexpr const SideLaw& side_law(SideKind kind) {
  return side_laws[static_cast<std::size_t>(kind)];
}

static_assert([] {
  for (const SideLaw& law : side_laws) {
    if (&side_law(law.kind) != &law) return false;
  }
  return true;
}());

/// One side of the domain.
struct Side {
  SideKind kind = SideKind::free;
  double velocity = 0.0;  ///< m/s along the shock axis, of sides that drive
  double friction = 0.0;  ///< coefficient of Coulomb friction, of sides that drive
  std::string behind{};   ///< name of the material that waves leave into, of sides that let out
  bool operator==(const Side&) const = default;
};

struct Boundary {
  Side low;                                                         ///< shock axis, coordinate 0
  Side high;                                                        ///< shock axis, coordinate size
  std::array<SideKind, 2> lateral{SideKind::free, SideKind::free};  ///< both sides of x (and y)
  bool operator==(const Boundary&) const = default;
};

/// The side at the low or high end of an axis.
inline Side side_at(const Boundary& boundary, int axis, bool high, int dimension) {
  if (axis + 1 == dimension) return high ? boundary.high : boundary.low;
  Side side;
  side.kind = boundary.lateral[static_cast<std::size_t>(axis)];
  return side;
}

/// Its kind.
inline SideKind side_kind(const Boundary& boundary, int axis, bool high, int dimension) {
  if (axis + 1 < dimension) return boundary.lateral[static_cast<std::size_t>(axis)];
  return high ? boundary.high.kind : boundary.low.kind;
}

}  // namespace poreshock
