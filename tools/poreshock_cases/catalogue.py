"""The hard cases, and what is known to miss its bar."""
from collections.abc import Callable
from dataclasses import dataclass

from poreshock_cases import bits, contacts, free, impact, voids

POROUS_GUARDS = 1e-4  # of the particle-steps, where voids collapse


@dataclass(frozen=True)
class Case:
    """A case: title, the function that runs it and returns its rows, particle-steps that guards may take."""
    title: str
    rows: Callable
    guard_share: float = 0.0


CASES = {
    "rest": Case("block at rest on the wall", free.rest),
    "flight": Case("uniform translation through the grid", free.flight),
    "spinning": Case("spinning elastic disc", free.spinning),
    "plate": Case("solid plate, 300 to 3000 m/s", impact.solid),
    "fluid": Case("plate without strength", impact.fluid),
    "elastic": Case("plate that cannot yield, 300 m/s", impact.elastic),
    "two_waves": Case("elastic precursor and plastic front", impact.two_waves),
    "release": Case("release from a free surface, 1100 m/s", impact.release),
    "tension": Case("two rarefactions meet", impact.tension),
    "very_porous": Case("void fraction 0.6 at 3 km/s", voids.very_porous, POROUS_GUARDS),
    "ligament": Case("ligament of 2-3 particles between two voids", voids.ligament, POROUS_GUARDS),
    "void_at_boundary": Case("void at the wall, void open to the free surface", voids.at_boundary, POROUS_GUARDS),
    "closing": Case("void walls that close, are sheared, and pulled apart", voids.closing),
    "spray": Case("single particles in empty space", free.spray),
    "needle": Case("needle of aspect ratio 20 on the wall", free.needle),
    "slender": Case("needle of aspect ratio 20 on another grain", contacts.slender),
    "small": Case("grains smaller than a cell", contacts.small),
    "layers": Case("soft and stiff grain: modulus 1000 times, density 20 times", contacts.layers),
    "crowd": Case("three and four grains at a node", contacts.crowd, POROUS_GUARDS),
    "steps": Case("time.cfl from 0.2 to 1.5", impact.steps, POROUS_GUARDS),
    "restart": Case("restart in the middle of a shock", bits.restart, POROUS_GUARDS),
    "ranks": Case("cuts through voids", bits.ranks, POROUS_GUARDS),
    "scale": Case("scale invariance", bits.scale, POROUS_GUARDS),
    "frames": Case("Galilean invariance", impact.frames),
    "symmetry": Case("mirror image and periodic shift", bits.symmetry, POROUS_GUARDS),
}

LIMITERS = ("Where a limiter sets in, rounding decides which of two jumps is the smaller; while voids collapse the "
            "difference grows.")
KNOWN = {
    ("spinning", "APIC: drift per turn of the mean von Mises stress, turns 5 to 10"):
        "The stress at the steps of the rim, which a lattice makes of a circle, relaxes slowly.",
    ("slender", "particles lost"):
        "A piece of the needle, 10 of 880 particles, breaks off and leaves at the top after 0.96 of 1 us; with APIC none "
        "does.",
    ("symmetry", "mirrored: largest difference of T and P"): LIMITERS,
    ("symmetry", "shifted by one cell: largest difference of T and P"): LIMITERS,
    ("closing", "slot: largest mean tension / largest compression"):
        "10 % while the walls part, with 6.25 um cells; without self-contact 16 %.",
    ("very_porous", "wall stress, void fraction 0.5997"):
        "The stress on the wall swings by 10 % over 100 ns with 16 cells per void, and 10 % of the space behind the "
        "front are gaps that collapsed voids leave numerically.",
}
