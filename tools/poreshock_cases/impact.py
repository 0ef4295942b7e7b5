"""Hard cases of plane impact: the solid plate, its limits of strength, release, tension, step, frame."""
import numpy

import plate_exact
import plate_release
from poreshock_cases import plate
from poreshock_cases.always import DRIFT
from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, near

ALUMINIUM = plate_exact.Material()
CELL = 20e-6  # m
VELOCITIES = (300.0, 700.0, 1100.0, 1500.0, 2000.0, 3000.0)


def solid(case, lab):
    """Six impact velocities against the exact solution."""
    rows, worst = [], {"stress": 0.0, "density": 0.0, "front, cells": 0.0}
    for velocity in VELOCITIES:
        run, exact = plate.shock(lab, f"{velocity:g}", velocity)
        state, final = run.particles(), exact.final
        found = plate.measure(state, CELL)
        front = plate.front_height(final, velocity, state["time"])
        for name, error in (("stress", found.stress / final.stress - 1.0),
                            ("density", found.density / final.density - 1.0),
                            ("front, cells", (found.front - front) / CELL)):
            worst[name] = max(worst[name], error, key=abs)
        rows.append(near(case, f"{velocity:g} m/s: temperature rise", found.temperature - 300.0,
                         final.temperature - 300.0, 0.05 if velocity == 3000.0 else 0.02, unit=" K"))
    bars = {"stress": 5e-3, "density": 1e-3, "front, cells": 1.0}
    return rows + [limit(case, f"worst error of the {name}", worst[name], bar, "+.2g") for name, bar in bars.items()]


def fluid(case, lab):
    """No yield stress, and no shear modulus either."""
    rows = []
    material = plate_exact.Material(yield_stress=0.0, hardening=0.0)
    for name, settings in (("Y = 0", ()), ("G = 0", ("material.0.young=0",))):
        run, exact = plate.shock(lab, name.replace(" ", ""), 1100.0, "material.0.yield=0", "material.0.hardening=0",
                                 *settings, material=material)
        state = run.particles()
        found = plate.measure(state, CELL)
        shear = float(numpy.max(abs(state["stress"][:, :3] + state["pressure"][:, None])))
        rows += [near(case, f"{name}: stress", found.stress, exact.final.stress, 5e-3, unit=" GPa", scale=1e9),
                 near(case, f"{name}: temperature rise", found.temperature - 300.0,
                      exact.final.temperature - 300.0, 0.02, unit=" K"),
                 limit(case, f"{name}: largest deviator / pressure", shear / exact.final.pressure, 1e-12)]
    return rows


def elastic(case, lab):
    """A yield stress beyond reach: the whole shock is elastic."""
    material = plate_exact.Material(yield_stress=1e30)
    final = plate_exact.jump_to_velocity(material, plate_exact.at_rest(material), 300.0)
    run = plate.shock(lab, "elastic", 300.0, "material.0.yield=1e30", "time.end=450e-9")[0]
    state = run.particles()
    found = plate.measure(state, CELL)
    # A snapshot's stress has the pressure in it; xx of the deviator is minus half the axial part.
    deviator = float(numpy.median(-(state["stress"][:, 1] + state["pressure"])[state["density"] > 2750.0]))
    return [near(case, "stress", found.stress, final.stress, 5e-3, unit=" GPa", scale=1e9),
            near(case, "density", found.density, final.density, 1e-3),
            near(case, "axial deviator", deviator, final.deviator, 5e-3, unit=" GPa", scale=1e9),
            near(case, "temperature rise", found.temperature - 300.0, final.temperature - 300.0, 0.02, unit=" K"),
            limit(case, "largest plastic strain", float(numpy.max(state["plastic_strain"])), 1e-300)]


# Impact velocity: bars of the elastic plateau, of the arrival of the precursor and of the plastic front.
TWO_WAVE_BARS = {500.0: (0.03, 0.01, 0.005), 700.0: (0.05, 0.02, 0.01)}


def two_waves(case, lab, cell=10e-6):
    """Elastic precursor and plastic front."""
    rows = []
    for velocity, (plateau, precursor, front) in TWO_WAVE_BARS.items():
        run, exact = plate.shock(lab, f"{velocity:g}", velocity, cell=cell)
        state = run.particles()
        found = plate.two_waves(state, cell, exact)
        name = f"{velocity:g} m/s: "
        # At one time the heights of a front and its arrival times have the same relative error.
        rows += [near(case, name + "elastic plateau", found.limit, exact.precursor.stress, plateau, unit=" MPa",
                      scale=1e6),
                 near(case, name + "arrival of the precursor", found.precursor,
                      plate.front_height(exact.precursor, velocity, state["time"]), precursor, unit=" mm", scale=1e-3),
                 near(case, name + "arrival of the plastic front", found.front,
                      plate.front_height(exact.final, velocity, state["time"]), front, unit=" mm", scale=1e-3)]
    return rows


def release(case, lab, cell=CELL):
    """Free-surface velocity and residual temperature, both hardenings, both thermal modes."""
    rows = []
    for thermal, share in (("conserving", 0.0), ("conserving", 1.0), ("paper", 0.0)):
        found, end = plate.released(lab, f"{thermal}_{share:g}", 1100.0, share, thermal, cell)
        name = f"{thermal}, {'kinematic' if share else 'isotropic'}: "
        rise = plate_release.temperature(ALUMINIUM, end, thermal) - 300.0
        rows += [near(case, name + "free-surface velocity", found.velocity, 1100.0 + end.gain, 5e-3, ".6g", " m/s"),
                 near(case, name + "residual temperature rise", found.temperature - 300.0, rise, 0.10, ".4g", " K")]
        if thermal == "paper":
            rows.append(limit(case, name + "T - T_H(V) - W_p/c_v of a particle, K", found.paper_excess, 1e-6))
    return rows


def tension(case, lab):
    """Two rarefactions meet in the thick plate."""
    run = lab.run("two_plates", "hard/two_plates.toml")
    shocked = plate_exact.solve(ALUMINIUM, 300.0).final
    once = plate_release.release(ALUMINIUM, shocked).gain
    pulled = plate_release.release(ALUMINIUM, shocked, gain=2.0 * once)
    last = run.particles()
    _, means = plate.row_means(last, CELL)
    lowest = min(float(numpy.min(particles(path)["pressure"])) for path in run.snapshots)
    return [near(case, "largest mean tension of a row of cells", -float(numpy.nanmin(means)), -pulled.stress, 0.05,
                 unit=" GPa", scale=1e9),
            check(case, "lowest pressure of a particle, any time", f"{lowest / 1e9:.2f} GPa",
                  f"> {1.1 * pulled.pressure / 1e9:.2f} GPa", lowest > 1.1 * pulled.pressure)]


def steps(case, lab):
    """The plate and a porous block over the allowed steps."""
    rows = []
    for cfl in (0.2, 0.35, 0.5, 0.7, 1.0, 1.5):
        for name in ("plate", "porous"):
            if name == "plate":
                run, exact = plate.shock(lab, f"plate_{cfl}", 1100.0, f"time.cfl={cfl}", height=2e-3, may_fail=True)
            else:
                run = lab.run(f"porous_{cfl}", "hard/powers_of_two.toml", f"time.cfl={cfl}", may_fail=True)
            good = run.code == 0 and run.drift < DRIFT
            text = f"drift {run.drift:.1e}" if run.code == 0 else f"stopped, exit code {run.code}"
            if good and name == "plate":
                error = plate.measure(run.particles(), CELL).stress / exact.final.stress - 1.0
                text += f", stress {100.0 * error:+.2f} %"
                good = abs(error) < 5e-3
            # Beyond the range a run may stop, but it has to say so and leave the state.
            stopped = run.code == 3 and (run.folder / "failed.h5").exists()
            bar = "drift < 1e-10" + (", stress 0.5 %" if name == "plate" else "")
            rows.append(check(case, f"cfl {cfl:g}, {name}", text, bar if cfl <= 1.0 else bar + ", or a clean stop",
                              good or (cfl > 1.0 and stopped)))
    return rows


def frames(case, lab):
    """The same shock with the wall moving, and seen from moving frames."""
    return moving_plates(case, lab) + plates_in_a_frame(case, lab)


def moving_plates(case, lab, cell=CELL):
    """The plate on a moving wall and in frames that move at 1000 m/s; the grid rides with the wall."""
    end = "time.end=300e-9"
    base = plate.measure(plate.shock(lab, "falling", 1100.0, end, cell=cell)[0].particles(), cell)
    rows = []
    for name, wall, settings in (
            ("wall moves up", 1100.0, ("boundary.low={kind=\"wall\", velocity=1100}", "loading.velocity=0")),
            ("frame 1000 m/s sideways", 0.0, ("loading.frame=[1000, 0]",)),
            ("frame 1000 m/s upwards", 1000.0, ("loading.frame=[0, 1000]",))):
        run = plate.shock(lab, name.replace(" ", "_").replace("/", ""), 1100.0, *settings, end, cell=cell)[0]
        state = run.particles()
        state["position"][:, 1] -= wall * state["time"]
        found = plate.measure(state, cell)
        rows += [near(case, f"{name}: stress", found.stress, base.stress, 2e-3, unit=" GPa", scale=1e9),
                 near(case, f"{name}: temperature rise", found.temperature - 300.0, base.temperature - 300.0, 0.01,
                      unit=" K")]
    return rows


def plates_in_a_frame(case, lab):
    """Two plates with no wall to ride with: the grid stays while both fly through it."""
    rows, end = [], "time.end=80e-9"
    for frame in ((0, 0), (0, 1000), (1000, 1000)):
        run = lab.run(f"plates_{frame[0]}_{frame[1]}", "hard/two_plates.toml", f"loading.frame={list(frame)}", end)
        state = run.particles()
        height = run.particles(0)["position"][:, 1]
        inside = (height > 1.2e-3) & (height < 1.6e-3)
        found = (float(numpy.mean(plate.axial_stress(state)[inside])), float(numpy.mean(state["temperature"][inside])))
        if frame == (0, 0):
            base = found
            continue
        name = f"two plates, frame {frame[0]}, {frame[1]} m/s: "
        rows += [near(case, name + "stress", found[0], base[0], 2e-3, unit=" GPa", scale=1e9),
                 near(case, name + "temperature rise", found[1] - 300.0, base[1] - 300.0, 0.01, unit=" K")]
    return rows
