"""The Slurm scripts for real: submitted, stopped at the limit, submitted by themselves, done with the same bits."""
import re
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "app"))

from faults import SCENE  # noqa: E402
from one_node import NoSlurm, OneNode  # noqa: E402
from program import PROGRAM, ROOT, ProgramTest, Result, closing_lines, history  # noqa: E402

# Slurm looks at limits twice a minute and gives notice up to half a minute early: with a limit of two
# minutes and a notice of 70 s a job is stopped 20 to 50 s after its start.
LIMIT, NOTICE = "2", "B:USR1@70"

LONG = SCENE.replace("max_steps = 700", "max_steps = 0").replace("end = 500e-9", "end = 1e-3").replace(
    "snapshot = 10e-9", "snapshot = 100e-9").replace('high = "free"', 'high = "wall"')


class Slurm(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        try:
            cls.slurm = OneNode(cls.make("slurm"))
        except NoSlurm as reason:
            raise unittest.SkipTest(f"no Slurm: {reason}") from None
        cls.addClassCleanup(cls.slurm.close)
        cls.tree = cls.make("poreshock")
        for name in ("tools", "jobscripts"):
            (cls.tree / name).symlink_to(ROOT / name)
        (cls.tree / "build/release").mkdir(parents=True)
        (cls.tree / "build/release/poreshock").symlink_to(PROGRAM)

    @classmethod
    def make(cls, name):
        (cls.folder / name).mkdir()
        return cls.folder / name

    def submit(self, *arguments, **environment):
        said = self.slurm.call("sbatch", "--ntasks=2", *arguments, cwd=self.tree, **environment)
        self.assertRegex(said, r"^Submitted batch job \d+\n$")
        return said.strip()

    def wait_for_jobs(self, seconds, meanwhile=lambda: None):
        """Until no job waits or runs; prints what changes."""
        end, last = time.monotonic() + seconds, None
        while True:
            jobs = self.slurm.jobs()
            if jobs != last:
                print(f"{time.strftime('%H:%M:%S')} squeue: {jobs or 'empty'}", flush=True)
                last = jobs
            if not jobs:
                return
            self.assertLess(time.monotonic(), end, "jobs do not end")
            meanwhile()
            time.sleep(0.2)

    def logs(self):
        """What the jobs printed, in the order of their numbers."""
        paths = sorted(self.tree.glob("slurm-*.out"), key=lambda path: re.findall(r"\d+", path.name))
        for path in paths:
            print(f"{path.name}:\n  " + path.read_text().strip().replace("\n", "\n  "), flush=True)
        texts = [path.read_text() for path in paths]
        for path in paths:
            path.unlink()
        return texts

    def end_after_two_stops(self):
        """Gives the scene an end 200 steps after the latest stop, which the next job of the chain reads."""
        texts = "".join(path.read_text() for path in self.tree.glob("slurm-*.out"))
        stops = [int(step) for step in re.findall(r"^stopped at step (\d+),", texts, re.M)]
        if len(stops) >= 2:
            (self.tree / "long.toml").write_text(LONG.replace("max_steps = 0", f"max_steps = {max(stops) + 200}"))

    def test_chain(self):
        (self.tree / "long.toml").write_text(LONG)
        print(self.submit(f"--time={LIMIT}", "jobscripts/slurm_chain.sh", "long.toml", "out", "--quiet",
                          SBATCH_SIGNAL=NOTICE), flush=True)
        self.wait_for_jobs(900, self.end_after_two_stops)
        logs = self.logs()
        self.assertGreaterEqual(len(logs), 3)
        for text in logs[:-1]:
            self.assertIn("Stopping: waiting for the checkpoint.\n", text)
            self.assertIn("asked to stop: checkpoint out/checkpoint_", text)
            self.assertRegex(text, r"\nSubmitted batch job \d+\n$")
        self.assertTrue(all(text.startswith("restart from out/checkpoint_") for text in logs[1:]))
        self.assertIn("\nThe run is done.\n", logs[-1])
        whole = self.run_scene("poreshock/long.toml", "whole")
        print("in one go:\n  " + whole.output.strip().replace("\n", "\n  "), flush=True)
        self.assertIn("escaped particles 0 ", whole.output)
        last = re.sub(r"^restart from .*\n", "", logs[-1]).replace("The run is done.\n", "").replace("in out\n", "in whole\n")
        self.assertEqual(closing_lines(Result(0, last, "")), closing_lines(whole))
        self.assertEqual((self.tree / "out/history.csv").read_bytes(), (self.folder / "whole/history.csv").read_bytes())
        for name in ("morphology.h5", "profiles.h5"):
            self.assert_same_datasets(f"poreshock/out/{name}", f"whole/{name}")

    def test_single_run_and_array(self):
        (self.tree / "short.toml").write_text(SCENE.replace("max_steps = 700", "max_steps = 60"))
        print(self.submit("--time=5", "jobscripts/slurm.sh", "short.toml", "single", "--quiet"), flush=True)
        (self.tree / "sweep").write_text("".join(f"--quiet --set loading.velocity={v}\n" for v in (700, 1500)))
        print(self.submit("--time=5", "--array=1-2", "jobscripts/slurm_array.sh", "short.toml", "sweep_out", "sweep"),
              flush=True)
        self.wait_for_jobs(300)
        logs = self.logs()
        self.assertEqual(sum("finished at step 60, " in text for text in logs), 3)
        self.assertEqual(sum(bool(re.search(r"Run [12] is done\.", text)) for text in logs), 2)
        first, second = (history(self.tree / f"sweep_out/{number}/history.csv")["kinetic"][0] for number in (1, 2))
        self.assertAlmostEqual(second / first, (1500 / 700) ** 2, places=6)
        self.assertEqual((self.tree / "sweep_out/2/history.csv").read_bytes(),
                         (self.tree / "single/history.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
