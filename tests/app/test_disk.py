"""Exit 4: the disk takes no more. The run stops at once, and what it has written stays whole."""
import subprocess

from program import ENVIRONMENT, MPIRUN, POROUS, PROGRAM, ProgramTest


class DiskFull(ProgramTest):
    def test_checkpoint_that_does_not_fit(self):
        # Snapshots in single precision, so that a checkpoint is the largest file.
        self.write("porous.toml", POROUS.replace("[output]\n", "[output]\nprecision = \"single\"\n"))
        self.run_scene("porous.toml", "room", "--set", "time.max_steps=30")
        needed = (self.folder / "room/checkpoint_000000025.h5").stat().st_size
        snapshot = (self.folder / "room/snapshot_000000.h5").stat().st_size
        self.assertGreater(needed, snapshot + 4096)
        # A limit on the size of files that snapshots meet and checkpoints do not, in KiB.
        limit = f'ulimit -f {(needed + snapshot) // 2048}; exec "$@"'
        done = subprocess.run([MPIRUN, "-n", "1", "bash", "-c", limit, "bash", PROGRAM, "run", "porous.toml", "--quiet",
                               "--output", "full"], cwd=self.folder, text=True, env=ENVIRONMENT,
                              capture_output=True, check=False, timeout=300)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"^poreshock: cannot \S.* full/checkpoint_000000025\.h5\.part: the file would be "
                                      r"larger than the file size limit \(ulimit -f\)\n")
        self.assertEqual(done.stdout, "")
        self.assertEqual(sorted(path.name for path in (self.folder / "full").iterdir()),
                         ["history.csv", "morphology_000000.h5", "profile_000000.h5", "scene.toml", "snapshot_000000.h5",
                          "snapshots.xdmf"])
        for name in ("snapshot_000000.h5", "scene.toml"):
            info = self.succeed("info", f"full/{name}").output
            self.assertNotIn("damaged", info)
        rows = (self.folder / "room/history.csv").read_text().splitlines()
        before = [row for row in rows[1:] if int(row.split(",")[1]) <= 25]
        self.assertEqual((self.folder / "full/history.csv").read_text().splitlines(), [rows[0], *before])
