"""A run that is asked to stop, by a signal or by its wall time, ends well and goes on later."""
import os
import re
import signal
import subprocess
import time

import h5py

from faults import Running, tell
from program import PATIENCE, POROUS, PROGRAM, ProgramTest, Result, closing_lines

# Far longer than the test waits for it.
LONG = POROUS.replace("end = 20e-9", "end = 10e-6").replace("every_steps = 25", "every_steps = 0")


class Stop(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("long.toml", LONG)

    def assert_stopped(self, name, result):
        """The run said how to go on, and its checkpoint lets it: the same bits as in one go."""
        self.assertEqual(result.code, 0, str(result))
        match = re.match(rf"asked to stop: checkpoint ({name}/checkpoint_(\d{{9}})\.h5); "
                         r"continue with --restart latest\n", result.output)
        self.assertIsNotNone(match, str(result))
        _, word, reached = closing_lines(Result(0, result.output[match.end():], ""))
        self.assertEqual(word, "stopped")
        self.assertTrue(reached.startswith(f"step {int(match.group(2))}, "), reached)
        with h5py.File(self.folder / match.group(1)) as file:
            beats = int(file.attrs["time"] / 2.5e-9) + 2
        end = ("--set", f"time.end={beats * 2.5e-9!r}")
        continued = self.run_scene("long.toml", name, "--restart", "latest", *end)
        self.assertTrue(continued.output.startswith(f"restart from {match.group(1)}\n"), str(continued))
        whole = self.run_scene("long.toml", f"{name}-whole", *end, ranks=2)
        self.assertEqual(closing_lines(continued), closing_lines(whole))
        self.assertEqual((self.folder / name / "history.csv").read_bytes(),
                         (self.folder / f"{name}-whole/history.csv").read_bytes())
        self.assert_same_datasets(f"{name}/morphology.h5", f"{name}-whole/morphology.h5")

    def test_signal_to_mpirun(self):
        run = subprocess.Popen(self.command("run", "long.toml", "--quiet", "--output", "signal", ranks=2),
                               cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        history = self.folder / "signal/history.csv"
        try:
            while run.poll() is None and not (history.exists() and history.read_text().count("\n") > 2):
                time.sleep(0.005)
            run.send_signal(signal.SIGUSR1)
            output, errors = run.communicate(timeout=120 * PATIENCE)
        finally:
            run.kill()
        self.assert_stopped("signal", Result(run.returncode, output, errors))

    def test_signals_to_a_rank(self):
        """Each signal to one rank of two: all stop after the same step."""
        self.write("scene.toml", LONG)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1, signal.SIGUSR2):
            run = Running(self.command("run", "scene.toml", "--quiet", "--output", number.name, ranks=2), self.folder)
            self.addCleanup(run.stop)
            history = self.folder / number.name / "history.csv"
            run.wait_for(lambda path=history: path.exists() and path.read_text().count("\n") > 2)
            os.kill(run.rank(1), number)
            result = run.finish(30)
            self.assertEqual(result.code, 0, str(result))
            match = re.match(r"asked to stop: checkpoint (\S+\.h5); continue with --restart latest\n", result.output)
            self.assertIsNotNone(match, str(result))
            self.assertIn("content   intact\n", self.succeed("info", match[1]).output)
        tell("signal", "TERM, INT, HUP, XCPU, USR1 or USR2 to one rank, USR1 to mpirun", result.output.splitlines()[0])

    def test_end_of_the_terminal_that_nohup_ignores(self):
        """The run goes on to its end, without mpirun, which would have the signal back to its default."""
        self.write("scene.toml", LONG)
        run = Running(["nohup", str(PROGRAM), "run", "scene.toml", "--quiet", "--output", "nohup", "--set",
                       "time.max_steps=400"], self.folder)
        self.addCleanup(run.stop)
        history = self.folder / "nohup/history.csv"
        run.wait_for(lambda: history.exists() and history.read_text().count("\n") > 1)
        run.process.send_signal(signal.SIGHUP)
        result = run.finish(60)
        self.assertEqual(result.code, 0, str(result))
        self.assertIn("finished at step 400, ", result.output)

    def test_wall_time(self):
        begin = time.monotonic()
        result = self.call("run", "long.toml", "--quiet", "--output", "wall", "--wall-time", "0.2", ranks=2)
        self.assertLess(time.monotonic() - begin, 60)
        self.assert_stopped("wall", result)
        tell("wall time", "--wall-time 0.2", result.output.splitlines()[0])

    def test_wall_time_that_is_over_at_once(self):
        result = self.succeed("run", "long.toml", "--quiet", "--output", "none", "--wall-time", "1e-9")
        self.assertTrue(result.output.startswith("asked to stop: checkpoint none/checkpoint_000000000.h5; "), str(result))
        self.assertIn("\nstopped at step 0, time 0 ns, in none\n", result.output)
