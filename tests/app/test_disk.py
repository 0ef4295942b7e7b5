"""A file that the system does not take is said, and the run goes on without it."""
import subprocess

from program import ENVIRONMENT, MPIRUN, POROUS, PROGRAM, ProgramTest, Result, closing_lines


class DiskFull(ProgramTest):
    def test_checkpoint_that_does_not_fit(self):
        # Snapshots in single precision, so that a checkpoint is the largest file.
        self.write("porous.toml", POROUS.replace("[output]\n", "[output]\nprecision = \"single\"\n"))
        whole = self.run_scene("porous.toml", "room", "--set", "time.max_steps=30")
        needed = (self.folder / "room/checkpoint_000000025.h5").stat().st_size
        snapshot = (self.folder / "room/snapshot_000000.h5").stat().st_size
        self.assertGreater(needed, snapshot + 4096)
        # A limit on the size of files that snapshots meet and checkpoints do not, in KiB.
        limit = f'ulimit -f {(needed + snapshot) // 2048}; exec "$@"'
        done = subprocess.run([MPIRUN, "-n", "1", "bash", "-c", limit, "bash", PROGRAM, "run", "porous.toml", "--quiet",
                               "--output", "full", "--set", "time.max_steps=30"], cwd=self.folder, text=True, env=ENVIRONMENT,
                              capture_output=True, check=False, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"^warning: cannot \S.* full/checkpoint_000000025\.h5\.part: the file would be larger "
                                      r"than the file size limit \(ulimit -f\); the run goes on and tries again at the next "
                                      r"checkpoint, the newest one is none\n\Z")
        self.assertEqual(closing_lines(Result(0, done.stdout, "")), closing_lines(whole))
        self.assertEqual(sorted(path.name for path in (self.folder / "full").iterdir()),
                         sorted(path.name for path in (self.folder / "room").iterdir()
                                if not path.name.startswith("checkpoint")))
        for name in ("snapshot_000000.h5", "scene.toml"):
            info = self.succeed("info", f"full/{name}").output
            self.assertNotIn("damaged", info)
        self.assertEqual((self.folder / "full/history.csv").read_bytes(), (self.folder / "room/history.csv").read_bytes())
