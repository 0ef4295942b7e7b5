"""A run of 2000 steps, interrupted three times at random and continued on other numbers of ranks, is the run in one go."""
import os
import random
import re
import signal
import time

from faults import SCENE, FaultTest, tell
from program import closing_lines

# All optional state at once: conducted heat, back stress, spall; heat flows, voids collapse, material escapes.
LONG = (SCENE.replace("max_steps = 450", "max_steps = 2000").replace("end = 500e-9", "end = 1e-6")
        .replace("title", 'thermal = "paper"\ntitle').replace("every_steps = 50", "every_steps = 37")
        .replace("snapshot = 10e-9", "snapshot = 100e-9").replace("beat = 2.5e-9", "beat = 5e-9")
        .replace("every = 2.5e-9", "every = 5e-9").replace("[checkpoint]", "domains = true\n[conduction]\non = true\n[checkpoint]")
        + "conductivity = 237\nkinematic_share = 0.5\nspall = 2e9\n")


class Interrupted(FaultTest):
    text = LONG
    sample = ""

    @classmethod
    def setUpClass(cls):
        super(FaultTest, cls).setUpClass()
        cls.write("scene.toml", cls.text)
        cls.whole = closing_lines(cls.run_scene("scene.toml", "whole", ranks=2))

    def reached(self, output):
        """Step of the last row of the history."""
        path = self.folder / output / "history.csv"
        rows = path.read_text().split("\n")[1:-1] if path.exists() else []
        return int(rows[-1].split(",")[1]) if rows else 0

    def interrupt(self, ranks, step, harm, *arguments):
        """Runs until the step is passed, harms the run, and returns its result."""
        run = self.start("parts", *arguments, ranks=ranks)
        run.wait_for(lambda: self.reached("parts") >= step, seconds=200)
        time.sleep(random.random() * 0.05)  # not always just after a row
        harm(run)
        return run.finish(60)

    def test_on_one_three_two_and_four_ranks(self):
        seed = int(os.environ.get("PORESHOCK_SEED", time.time_ns() % 1_000_000))
        random.seed(seed)
        # At first the rows above the shock are still asleep.
        steps = [random.randrange(60, 180), random.randrange(700, 1200), random.randrange(1300, 1800)]
        onward = ("--restart", "latest")
        told = self.interrupt(1, steps[0], lambda run: run.process.send_signal(signal.SIGUSR1))
        self.assertEqual(told.code, 0, str(told))
        stops = [int(re.search(r"asked to stop: checkpoint \S+checkpoint_(\d+)\.h5", told.output)[1])]
        killed = self.interrupt(3, steps[1], lambda run: os.kill(run.rank(2), signal.SIGKILL), *onward)
        self.assertEqual(killed.code, 137, str(killed))
        told = self.interrupt(2, steps[2], lambda run: os.kill(run.rank(1), signal.SIGTERM), *onward)
        self.assertEqual(told.code, 0, str(told))
        stops.append(int(re.match(r"restart from \S+checkpoint_(\d+)\.h5", told.output)[1]))
        stops.append(int(re.search(r"asked to stop: checkpoint \S+checkpoint_(\d+)\.h5", told.output)[1]))
        print(f"seed {seed}: continued from steps {stops}", flush=True)
        last = self.run_scene("scene.toml", "parts", *onward, ranks=4)
        self.assertEqual(closing_lines(last), self.whole)
        self.assertIn("at step 2000,", last.output)
        self.assert_records_whole("parts")
        tell("interrupted", f"a run of 2000 steps{self.sample} with conduction, spall, rebalance and rows asleep, on 1 rank stopped by USR1, "
             "on 3 killed by kill -9, on 2 stopped by TERM to a rank, finished on 4",
             "asked to stop: checkpoint ...; continue with --restart latest",
             "nothing: checksum, history, morphology, profiles and snapshots are those of the run in one go")
