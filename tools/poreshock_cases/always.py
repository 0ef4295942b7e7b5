"""What must hold in every run: energy, guards, and the signs of heat and plastic work."""
import numpy

from poreshock_cases.program import particles
from poreshock_cases.table import check, limit

DRIFT = 1e-10
COLDEST = 1.0  # K, where a temperature is set to the floor


def bad_particles(run):
    """Particles of all snapshots with a negative plastic strain, a temperature at or below the
    floor, or a plastic work that fell since the snapshot before (isotropic hardening only)."""
    isotropic = all(material["kinematic_share"] == 0.0 for material in run.scene["material"])
    bad, before = 0, None
    for path in run.snapshots:
        now = particles(path)
        bad += int(numpy.count_nonzero(~(now["plastic_strain"] >= 0.0) | ~(now["temperature"] > COLDEST)))
        if before is not None and isotropic:
            _, a, b = numpy.intersect1d(before["id"], now["id"], return_indices=True)
            bad += int(numpy.count_nonzero(~(now["plastic_work"][b] >= before["plastic_work"][a])))
        before = now
    return bad


def guard_hits(runs):
    """Guard counts of all runs as text, their sum, and the particle-steps of all runs."""
    sums = {}
    for run in runs:
        for name, count in run.guards.items():
            sums[name] = sums.get(name, 0) + count
    text = ", ".join(f"{name} {count}" for name, count in sums.items() if count) or "0"
    return text, sum(sums.values()), sum(run.timings["particle_steps"] for run in runs)


def always(case, runs, guard_share=0.0):
    """Rows on all runs of a case; guards may act in `guard_share` of the particle-steps."""
    text, hits, steps = guard_hits(runs)
    bar = f"< {guard_share:g} of {steps:.1e} particle-steps" if guard_share else "0"
    bad = sum(bad_particles(run) for run in runs)
    return [limit(case, f"energy drift, worst of {len(runs)} runs", max(run.drift for run in runs), DRIFT),
            check(case, "guard counts", text, bar, hits <= guard_share * steps),
            check(case, "particles with eps_p < 0, T at the floor, or falling W_p", bad, "0", bad == 0)]
