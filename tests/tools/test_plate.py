"""The exact plane shock and its release against published rows, and the measuring of a snapshot against itself."""
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import plate_exact  # noqa: E402
import plate_release  # noqa: E402
from poreshock_cases import plate as measuring  # noqa: E402

# Up: front m/s, rho, P GPa, sigma GPa, s MPa, plastic strain, T K; paper's aluminium with strength.
ALUMINIUM = {
    100: "5510.5 2748.815 1.44257 1.52522 82.65 0.01035 311.54",
    300: "5777.4 2847.111 4.61700 4.70562 88.62 0.03366 337.54",
    500: "6044.3 2943.033 8.08076 8.17500 94.24 0.05564 369.88",
    700: "6311.3 3036.662 11.83389 11.93346 99.56 0.07642 412.43",
    900: "6576.9 3128.053 15.87718 15.98178 104.60 0.09609 469.12",
    1000: "6709.2 3172.921 18.00783 18.11485 107.02 0.10554 503.95",
    1100: "6841.8 3217.256 20.21090 20.32027 109.37 0.11474 543.54",
    1300: "7107.8 3304.364 24.83430 24.94822 113.91 0.13247 638.52",
    1500: "7374.2 3389.452 29.74740 29.86563 118.23 0.14933 756.91",
    2000: "8041.8 3593.774 43.29753 43.42570 128.17 0.18816 1172.36",
}
# Up: free-surface velocity and temperature after release, isotropic and kinematic hardening, by another
# integrator; its last digits are open.
RELEASED = {
    300: (596.48, 305.82, 597.13, 305.40), 700: (1397.57, 330.21, 1399.02, 328.43),
    1100: (2202.90, 387.11, 2205.01, 383.42), 2000: (4037.27, 649.91, 4040.42, 641.00),
}
# Without strength: front, rho, P GPa, T K.
HYDRODYNAMIC = {300: "5752 2848.57 4.6591 336.414", 1100: "6824 3218.87 20.2673 540.567",
                3000: "9370 3971.59 75.8970 2623.148"}


class Exact(unittest.TestCase):
    def test_every_digit_of_the_table_with_strength(self):
        for velocity, row in ALUMINIUM.items():
            plate = plate_exact.solve(plate_exact.Material(), velocity)
            state = plate.final
            self.assertEqual(f"{state.front:.1f} {state.density:.3f} {state.pressure / 1e9:.5f} "
                             f"{state.stress / 1e9:.5f} {state.deviator / 1e6:.2f} "
                             f"{state.plastic_strain:.5f} {state.temperature:.2f}", row)
            self.assertEqual(plate.precursor is None, velocity >= 900)

    def test_precursor_and_overdriven_limit(self):
        state = plate_exact.solve(plate_exact.Material(), 300.0).precursor
        self.assertEqual(f"{state.front:.1f} {state.stress / 1e6:.2f} {state.velocity:.3f} "
                         f"{state.density:.3f} {state.pressure / 1e6:.2f} {state.temperature:.2f}",
                         "6451.8 259.66 14.906 2706.252 179.66 301.39")
        self.assertIsNotNone(plate_exact.solve(plate_exact.Material(), 805.1).precursor)
        self.assertIsNone(plate_exact.solve(plate_exact.Material(), 805.3).precursor)
        with self.assertRaisesRegex(ValueError, "elastic"):
            plate_exact.solve(plate_exact.Material(), 14.0)

    def test_without_strength_the_front_obeys_the_linear_law(self):
        fluid = plate_exact.Material(yield_stress=0.0, hardening=0.0)
        for velocity, row in HYDRODYNAMIC.items():
            state = plate_exact.solve(fluid, velocity).final
            self.assertEqual(f"{state.front:.0f} {state.density:.2f} {state.pressure / 1e9:.4f} "
                             f"{state.temperature:.3f}", row)

    def test_another_material(self):
        shear = 27.6e9
        flyer = plate_exact.Material(density=2785.0, c0=5328.0, gruneisen_slope=1.338, young=2.6 * shear,
                                     poisson=0.3, yield_stress=0.3e9, hardening=0.0, cv=884.0)
        plate = plate_exact.solve(flyer, 400.0)
        self.assertEqual(f"{plate.precursor.front:.1f} {plate.precursor.velocity:.2f} "
                         f"{plate.final.stress / 1e9:.5f} {plate.final.density:.2f} "
                         f"{plate.final.temperature:.1f} {plate.final.front:.1f}",
                         "6484.9 35.15 6.63602 2985.62 354.5 5909.2")

    def test_a_fast_impact_without_hardening(self):
        # The second jump of such a solid has no velocity at the limit of compression.
        copper = plate_exact.Material(density=8930.0, young=127.8e9, poisson=0.34, hardening=0.0, c0=3940.0,
                                      gruneisen_slope=1.489, gamma=2.02, cv=383.0)
        found = plate_exact.solve(copper, 3000.0)
        self.assertIsNone(found.precursor)
        self.assertAlmostEqual(found.final.velocity, 3000.0, places=6)
        self.assertAlmostEqual(found.final.stress / (8930.0 * found.final.front * 3000.0), 1.0, places=12)
        self.assertAlmostEqual(found.final.front / (3940.0 + 1.489 * 3000.0), 1.0, places=3)

    def test_paper_mode_without_strength_is_the_hugoniot(self):
        fluid = plate_exact.Material(yield_stress=0.0, hardening=0.0)
        for velocity, row in HYDRODYNAMIC.items():
            state = plate_exact.solve(fluid, velocity, "paper").final
            self.assertEqual(f"{state.front:.0f} {state.density:.2f} {state.pressure / 1e9:.4f} "
                             f"{state.temperature:.3f}", row)

    def test_paper_mode_with_strength_adds_the_plastic_work(self):
        material = plate_exact.Material()
        state = plate_exact.solve(material, 1100.0, "paper").final
        # Momentum over one jump, and eqs 4 and 7 with the work added up in small steps.
        self.assertAlmostEqual(state.stress * (1.0 / 2700.0 - state.volume) / 1100.0**2, 1.0, places=12)
        steps = (numpy.arange(100000) + 0.5) * state.plastic_strain / 100000
        flow = material.yield_stress + material.hardening * steps
        volume = numpy.exp(-(flow + 3.0 * material.shear * steps) / (2.0 * material.shear)) / 2700.0
        work = numpy.sum(flow * volume) * state.plastic_strain / 100000
        self.assertAlmostEqual(state.plastic_work / work, 1.0, places=9)
        hugoniot = plate_exact.reference(material, state.volume)[0]
        self.assertAlmostEqual((state.pressure - hugoniot) * state.volume / (2.0 * work), 1.0, places=6)
        self.assertAlmostEqual(state.temperature - plate_exact.reference_temperature(material, state.volume),
                               work / 880.0, places=6)

    def test_release_with_both_hardenings(self):
        for velocity, row in RELEASED.items():
            found = []
            for share in (0.0, 1.0):
                material = plate_exact.Material(kinematic_share=share)
                end = plate_release.release(material, plate_exact.solve(material, velocity).final)
                self.assertLess(abs(end.stress), 10.0)
                found += [velocity + end.gain, plate_release.temperature(material, end)]
            for value, published in zip(found, row):
                self.assertAlmostEqual(value, published, delta=0.025)

    def test_release_of_a_fluid_is_an_isentrope(self):
        fluid = plate_exact.Material(yield_stress=0.0, hardening=0.0)
        for velocity, surface, residual in ((300, 600.15, 302.155), (1100, 2207.93, 376.662),
                                            (3000, 6121.74, 1102.460)):
            shocked = plate_exact.solve(fluid, velocity).final
            end = plate_release.release(fluid, shocked)
            temperature = plate_release.temperature(fluid, end)
            self.assertAlmostEqual(velocity + end.gain, surface, delta=0.01)
            self.assertAlmostEqual(temperature, residual, delta=0.001)
            constant = shocked.temperature * shocked.volume**2
            self.assertAlmostEqual(temperature * end.volume**2 / constant, 1.0, places=7)

    def test_release_of_the_paper_mode_leaves_the_plastic_work(self):
        material = plate_exact.Material()
        end = plate_release.release(material, plate_exact.solve(material, 1100.0, "paper").final, "paper")
        # At zero stress a remainder of volume and deviator is left besides the work.
        expansion = plate_exact.reference_temperature(material, end.volume) - 300.0
        self.assertAlmostEqual(plate_release.temperature(material, end, "paper"),
                               300.0 + expansion + end.plastic_work / 880.0, places=9)
        self.assertLess(abs(expansion), 1.0)
        self.assertGreater(end.plastic_work, 12.0 * 880.0)

    def test_release_to_a_velocity(self):
        material = plate_exact.Material()
        shocked = plate_exact.solve(material, 300.0).final
        end = plate_release.release(material, shocked)
        again = plate_release.release(material, shocked, gain=end.gain)
        self.assertAlmostEqual(again.volume / end.volume, 1.0, places=9)
        self.assertLess(plate_release.release(material, shocked, gain=2.0 * end.gain).stress, -4e9)

    def test_energy_of_one_wave_is_half_the_velocity_squared(self):
        self.assertAlmostEqual(plate_exact.solve(plate_exact.Material(), 1100.0).final.energy, 605e3, places=3)

    def test_names_of_a_scene(self):
        found = plate_exact.material_from_scene({"name": "x", "yield": 1e8, "lambda": 1.5, "density": 8930.0})
        self.assertEqual((found.yield_stress, found.gruneisen_slope, found.density), (1e8, 1.5, 8930.0))


def exact_snapshot(velocity, time, dimension):
    """Particles of the exact solution, on the lattice they started from."""
    material, cell, height = plate_exact.Material(), 20e-6, 2e-3
    plate = plate_exact.solve(material, velocity)
    rest = plate_exact.at_rest(material)
    axes = [numpy.arange(cell / 4, end, cell / 2) for end in [4 * cell] * (dimension - 1) + [height]]
    start = numpy.stack([axis.ravel() for axis in numpy.meshgrid(*axes, indexing="ij")], axis=1)
    y = start[:, -1]
    state = numpy.full(len(y), 0)
    states, position = [rest], y - velocity * time
    precursor = plate.precursor or rest
    for number, (before, behind) in enumerate(((rest, plate.precursor), (precursor, plate.final)), 1):
        states.append(behind)
        if behind is None or time == 0.0:
            continue
        # Lagrangian position of the jump, and the material behind it stacked back from the jump.
        front = (behind.front - velocity) * time
        behind_it = position < front
        squeezed = front - (front - position) * behind.density / before.density
        position = numpy.where(behind_it, squeezed, position)
        state = numpy.where(behind_it, number, state)

    def field(value):
        return numpy.array([value(s) if s else 0.0 for s in states])[state]

    stress = numpy.zeros((len(y), 4 if dimension == 2 else 6))
    stress[:, dimension - 1] = -field(lambda s: s.stress)
    start[:, -1] = position
    return {"position": start, "mass": numpy.full(len(y), 2700.0 * (cell / 2)**dimension),
            "density": field(lambda s: s.density), "stress": stress,
            "temperature": field(lambda s: s.temperature),
            "plastic_strain": field(lambda s: s.plastic_strain), "internal_energy": field(lambda s: s.energy),
            "kinetic_energy": field(lambda s: 0.5 * (velocity - s.velocity)**2)}


def energy(particles):
    """Kinetic and internal energy of all particles as a reader of a snapshot adds them up."""
    return float(numpy.sum(particles["mass"] * (particles["kinetic_energy"] + particles["internal_energy"])))


class Measuring(unittest.TestCase):
    def test_measures_the_exact_solution(self):
        for velocity in (300.0, 1100.0):
            for dimension in (2, 3):
                final = plate_exact.solve(plate_exact.Material(), velocity).final
                found = measuring.measure(exact_snapshot(velocity, 200e-9, dimension), 20e-6)
                self.assertAlmostEqual(found.stress / final.stress, 1.0, places=12)
                self.assertAlmostEqual(found.density / final.density, 1.0, places=12)
                self.assertAlmostEqual(found.temperature / final.temperature, 1.0, places=12)
                self.assertAlmostEqual(found.plastic_strain / final.plastic_strain, 1.0, places=12)
                self.assertLess(found.noise, 1e-12)
                self.assertLess(abs(found.overshoot), 1e-12)
                # A front inside a row is known to half a row.
                self.assertLess(abs(found.front - (final.front - velocity) * 200e-9), 0.5 * 20e-6)

    def test_the_exact_solution_keeps_its_energy(self):
        before, after = (exact_snapshot(300.0, time, 2) for time in (0.0, 200e-9))
        # A particle is on one side of a jump: the sum is exact to one particle row of 200.
        self.assertLess(abs(energy(after) / energy(before) - 1.0), 1.0 / 200.0)

    def test_no_front_is_an_error(self):
        particles = exact_snapshot(1100.0, 200e-9, 2)
        keep = particles["position"][:, -1] < 0.5e-3
        with self.assertRaisesRegex(ValueError, "no shock front"):
            measuring.measure({name: values[keep] for name, values in particles.items()}, 20e-6)

    def test_noise_and_overshoot(self):
        particles = exact_snapshot(1100.0, 200e-9, 2)
        final = plate_exact.solve(plate_exact.Material(), 1100.0).final
        front = measuring.front_height(final, 1100.0, 200e-9)
        height = particles["position"][:, -1]
        # Every other particle is 2 % above, every other 2 % below.
        sign = numpy.where(numpy.arange(len(height)) % 2 == 0, 1.0, -1.0)
        particles["stress"][:, 1] *= 1.0 + 0.02 * sign
        self.assertAlmostEqual(measuring.measure(particles, 20e-6).noise, 0.02, places=9)
        # One row just behind the front, outside the plateau, is 3 % above.
        row = numpy.floor(height / 20e-6)
        particles["stress"][row == numpy.floor(0.9 * front / 20e-6), 1] *= 1.03
        self.assertAlmostEqual(measuring.measure(particles, 20e-6).overshoot, 0.03, places=9)

    def test_both_fronts_of_two_waves(self):
        plate = plate_exact.solve(plate_exact.Material(), 300.0)
        found = measuring.two_waves(exact_snapshot(300.0, 200e-9, 2), 20e-6, plate)
        self.assertAlmostEqual(found.limit / plate.precursor.stress, 1.0, places=12)
        for height, state in ((found.front, plate.final), (found.precursor, plate.precursor)):
            self.assertLess(abs(height - measuring.front_height(state, 300.0, 200e-9)), 0.5 * 20e-6)

    def test_the_run_ends_before_the_wave_leaves_the_plate(self):
        plate = plate_exact.solve(plate_exact.Material(), 300.0)
        # 0.75 x 5 mm at 6451.76 m/s is 581.2 ns; the beat is 5 ns unless told otherwise.
        self.assertEqual(measuring.end_time(5e-3, plate), 580e-9)
        self.assertEqual(measuring.end_time(5e-3, plate, 1e-9), 581e-9)


if __name__ == "__main__":
    unittest.main()
