"""Exit 3: a state gone bad stops every rank, is kept for inspection, and costs nothing written before."""
import re

import h5py
import numpy

from program import POROUS, ProgramTest, datasets, history, particles

BAD = (r"^at step (\d+), time (\S+) ns, particles have a state that is not finite or were turned inside out: "
       r"look at failed\.h5, try a smaller time\.cfl or a larger viscosity\.linear$")
COLLAPSED = (r"^the time step collapsed to (\S+) s at step (\d+), time (\S+) s \(it began with (\S+) s\): a particle moves "
             r"or deforms far too fast; look at failed\.h5, try a larger viscosity\.linear or a smaller time\.cfl$")

# A scheme without what calms it.
UNSTEADY = tuple(part for setting in ("viscosity.linear=0", "viscosity.quadratic=0", "transfer.velocity='apic'") for part in ("--set", setting))


class BadState(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)

    def stopped(self, pattern, scene, output, *arguments, ranks=1):
        message = self.message(3, "run", scene, "--quiet", "--output", output, *arguments, ranks=ranks)
        match = re.match(pattern, message)
        self.assertIsNotNone(match, message)
        return match.groups()

    def assert_kept(self, output, step, time):
        """failed.h5 opens and has all particles; the records before it are as they were written."""
        self.assertFalse((self.folder / output / "poreshock.lock").exists())
        with h5py.File(self.folder / output / "failed.h5") as file:
            self.assertEqual(file.attrs["step"], step)
            # The message has six decimals of a nanosecond.
            self.assertLessEqual(abs(file.attrs["time"] - time), max(1e-5 * time, 5e-16))
        info = self.succeed("info", f"{output}/failed.h5").output
        self.assertTrue(info.startswith(f"{output}/failed.h5: snapshot of poreshock\ncontent   intact\n"), info)
        first = particles(self.folder / output / "snapshot_000000.h5")
        failed = particles(self.folder / output / "failed.h5")
        numpy.testing.assert_array_equal(first["id"], failed["id"])
        rows = history(self.folder / output / "history.csv")
        self.assertEqual(rows["step"][0], 0)
        self.assertLess(rows["step"][-1], step)
        self.assertEqual(list((self.folder / output).glob("*.part")), [])
        return failed

    def test_viscosity_that_overflows(self):
        """An artificial viscosity of 1e308 is infinite in the first compressed particle; what it would spoil is kept."""
        messages = set()
        for ranks in (1, 3):
            step, time = self.stopped(BAD, "porous.toml", f"infinite{ranks}", "--set", "viscosity.quadratic=1e308", ranks=ranks)
            failed = self.assert_kept(f"infinite{ranks}", int(step), 1e-9 * float(time))
            self.assertTrue(all(numpy.isfinite(values).all() for values in failed.values()))
            messages.add((step, time))
        self.assertEqual(len(messages), 1)

    def test_particles_turned_inside_out(self):
        """A body force that drives the sample through the wall within one step."""
        for ranks in (1, 2):
            step, time = self.stopped(BAD, "porous.toml", f"force{ranks}", "--set", "body_force.acceleration=[0.0, -1e25]",
                                   ranks=ranks)
            self.assertEqual(step, "1")
            self.assert_kept(f"force{ranks}", int(step), 1e-9 * float(time))

    def test_particles_far_outside_are_still_in_the_failed_state(self):
        step, time = self.stopped(BAD, "porous.toml", "sideways", "--set", "body_force.acceleration=[1e300, 0.0]", ranks=2)
        failed = self.assert_kept("sideways", int(step), 1e-9 * float(time))
        self.assertFalse(numpy.isfinite(failed["kinetic_energy"]).all())

    def test_collapsed_time_step(self):
        """A strong shock without any viscosity at the largest allowed step."""
        dt, step, time, began = self.stopped(COLLAPSED, "porous.toml", "collapsed", "--set", "loading.velocity=6000", "--set",
                                          "time.cfl=0.9", *UNSTEADY, ranks=2)
        self.assertLess(float(dt), 1e-5 * float(began))
        self.assertGreater(int(step), 30)
        self.assert_kept("collapsed", int(step), float(time))
        # Records and checkpoints from before are all there and whole.
        rows = history(self.folder / "collapsed/history.csv")
        self.assertGreaterEqual(len(rows["time"]), 3)
        curves = datasets(self.folder / "collapsed/morphology_000002.h5")
        numpy.testing.assert_array_equal(curves["temperature/time"], [5e-9])
        checkpoint = "collapsed/checkpoint_000000025.h5"
        self.assertIn("content   intact\n", self.succeed("info", checkpoint).output)

    def test_the_same_failure_again_after_a_restart(self):
        arguments = ("--set", "loading.velocity=6000", "--set", "time.cfl=0.9", *UNSTEADY)
        first = self.stopped(COLLAPSED, "porous.toml", "again", *arguments)
        second = self.stopped(COLLAPSED, "porous.toml", "again", *arguments, "--restart", "latest", ranks=2)
        self.assertEqual(first, second)
