"""What breaks a run: running programs that can be watched and harmed, small disks, and the table of it all."""
import json
import os
import re
import signal
import struct
import subprocess
import time
from pathlib import Path

from program import ALUMINIUM, ENVIRONMENT, MPIRUN, PATIENCE, PROGRAM, ProgramTest, Result, closing_lines, particles, same_bits

# Everything that was harmed must have ended by then.
SECONDS = 30

# A block of 20 x 40 cells with voids; long enough to harm it while it runs.
SCENE = """
title = "a run in trouble"
[domain]
size = [0.2e-3, 0.48e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "random_voids"
height = 0.4e-3
porosity = 0.15
void_radius = 25e-6
[loading]
velocity = 1500
[time]
end = 500e-9
max_steps = 450
[output]
beat = 2.5e-9
snapshot = 10e-9
[morphology]
every = 2.5e-9
fields = ["temperature"]
thresholds = { from = 310, to = 900, step = 10 }
[checkpoint]
every_steps = 50
keep = 3
""" + ALUMINIUM


class Running:
    """A started program, its texts so far, and its ranks."""

    def __init__(self, command, folder, environment=None):
        self.texts = [folder / f"{time.monotonic_ns()}.{name}" for name in ("out", "err")]
        self.files = [open(path, "w", encoding="utf-8") for path in self.texts]
        self.process = subprocess.Popen(command, cwd=folder, stdout=self.files[0], stderr=self.files[1],
                                        env=ENVIRONMENT | (environment or {}))

    def output(self):
        return self.texts[0].read_text()

    def errors(self):
        return self.texts[1].read_text()

    def wait_for(self, what, seconds=60):
        """Polls until `what()` is true; an error when the program ends or nothing happens before."""
        end = time.monotonic() + seconds * PATIENCE
        while not what():
            if self.process.poll() is not None and not what():
                raise AssertionError(f"ended too early with {self.process.poll()}\n{self.output()}\n{self.errors()}")
            if time.monotonic() > end:
                raise AssertionError(f"nothing happened\n{self.output()}\n{self.errors()}")
            time.sleep(0.001)

    def rank(self, number):
        """Process id of a rank."""
        found = []

        def search():
            found.extend(pid for pid in descendants(self.process.pid) if environment_of(pid).get(
                "OMPI_COMM_WORLD_RANK") == str(number) and Path(f"/proc/{pid}/exe").resolve() == PROGRAM.resolve())
            return found
        self.wait_for(search)
        return found[0]

    def finish(self, seconds):
        """The result; an error when it does not end in time."""
        try:
            code = self.process.wait(timeout=seconds * PATIENCE)
        except subprocess.TimeoutExpired:
            self.stop()
            raise AssertionError(f"did not end within {seconds} s\n{self.output()}\n{self.errors()}") from None
        self.stop()
        return Result(code, self.output(), self.errors())

    def stop(self):
        if self.process.poll() is None:
            ranks = descendants(self.process.pid)
            self.process.kill()
            self.process.wait()
            for pid in ranks:
                try:
                    os.kill(pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
        for file in self.files:
            file.close()


def descendants(pid):
    """Processes below a process; those that end meanwhile are left out."""
    found = []
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return found
    for child in map(int, children):
        found += [child, *descendants(child)]
    return found


def environment_of(pid):
    try:
        text = Path(f"/proc/{pid}/environ").read_bytes()
    except OSError:
        return {}
    return dict(part.decode(errors="replace").split("=", 1) for part in text.split(b"\0") if b"=" in part)


def poison(pid, value, by=float("nan")):
    """Stops a rank, overwrites one number in the middle of every row of at least 64 equal ones of this value, and lets
    it go on. Returns the number of places."""
    pattern = struct.pack("<d", value) * 64
    os.kill(pid, signal.SIGSTOP)
    places = 0
    try:
        with open(f"/proc/{pid}/maps", encoding="ascii") as maps, open(f"/proc/{pid}/mem", "r+b", 0) as memory:
            for line in maps:
                limits, rights = line.split()[:2]
                low, high = (int(part, 16) for part in limits.split("-"))
                if not rights.startswith("rw") or "[v" in line or high - low > 1 << 28:
                    continue
                memory.seek(low)
                try:
                    content = memory.read(high - low)
                except OSError:
                    continue
                at = content.find(pattern)
                while at >= 0:
                    memory.seek(low + at + 256)
                    memory.write(struct.pack("<d", by))
                    places += 1
                    end = at + len(pattern)
                    while content[end:end + 8] == pattern[:8]:
                        end += 8
                    at = content.find(pattern, end)
    finally:
        os.kill(pid, signal.SIGCONT)
    return places


class SmallDisk:
    """A file system of a few megabytes, mounted on a folder; `reason` says why there is none."""

    def __init__(self, folder, mebibytes):
        self.folder = folder
        folder.mkdir()
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={mebibytes}m", "none", folder], check=False,
                              capture_output=True, text=True)
        self.reason = done.stderr.strip() if done.returncode != 0 else None

    def remount(self, right):
        subprocess.run(["mount", "-o", f"remount,{right}", self.folder], check=True)

    def fill(self, but=0):
        """Takes all room but so many bytes."""
        with open(self.folder / "filler", "wb", 0) as file:
            for size in (1 << 16, 1 << 12, 1 << 8, 1):
                try:
                    while True:
                        if file.write(b"x" * size) < size:
                            break
                except OSError:
                    pass
            file.truncate(max(0, file.tell() - but))

    def make_room(self):
        (self.folder / "filler").unlink()

    def unmount(self):
        if self.reason is None:
            subprocess.run(["umount", "-l", self.folder], check=False)


def tell(fault, done, said, lost="nothing"):
    """One line of the table of faults, which tools/faults makes."""
    table = os.environ.get("PORESHOCK_FAULT_TABLE")
    if not table:
        return
    # Names of files without their folders, which are those of this test.
    said = re.sub(r"\S*/(?:\w+/)*(?=\w+\.(?:h5|csv|toml))", "", said)
    said = re.sub(r"\s+", " ", said).strip()
    with open(table, "a", encoding="utf-8") as file:
        file.write(json.dumps({"fault": fault, "done": done, "said": said, "lost": lost}) + "\n")


class FaultTest(ProgramTest):
    """Tests that harm a run of SCENE and compare it with one left in peace."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("scene.toml", SCENE)
        cls.whole = closing_lines(cls.run_scene("scene.toml", "whole"))

    def disk(self, mebibytes):
        disk = SmallDisk(self.folder / f"disk_{self._testMethodName}", mebibytes)
        self.addCleanup(disk.unmount)
        if disk.reason is not None:
            self.skipTest(f"no small disk: {disk.reason}")
        return disk

    def start(self, output, *arguments, ranks=2, wrapper=(), environment=None):
        command = [MPIRUN, "-n", str(ranks), *wrapper, PROGRAM, "run", "scene.toml", "--quiet", "--output", output, *arguments]
        running = Running([str(part) for part in command], self.folder, environment)
        self.addCleanup(running.stop)
        return running

    def rows(self, output):
        path = self.folder / output / "history.csv"
        return path.read_text().count("\n") if path.exists() else 0

    def assert_records_whole(self, output, left_out=()):
        """History, morphology, profiles and snapshots are those of the run left in peace."""
        self.assertEqual((self.folder / output / "history.csv").read_bytes(),
                         (self.folder / "whole/history.csv").read_bytes())
        for name in ("morphology.h5", "profiles.h5"):
            self.assert_same_datasets(f"{output}/{name}", f"whole/{name}")
        expected = sorted(path.name for path in (self.folder / "whole").glob("snapshot_*.h5"))
        names = sorted(path.name for path in (self.folder / output).glob("snapshot_*.h5"))
        self.assertEqual(names, [name for name in expected if name not in left_out])
        for name in names:
            a, b = particles(self.folder / output / name), particles(self.folder / "whole" / name)
            self.assertEqual(list(a), list(b))
            for field, values in a.items():
                self.assertTrue(same_bits(values, b[field]), f"{field} of {name}")
        self.assertEqual(list((self.folder / output).glob("*.part")), [])

    def assert_continues(self, output, ranks=1):
        """The run goes on from its newest good checkpoint to the very end of the run left in peace."""
        result = self.run_scene("scene.toml", output, "--restart", "latest", ranks=ranks)
        self.assertEqual(closing_lines(result), self.whole)
        self.assert_records_whole(output)
        return result

    def assert_checkpoints_intact(self, output):
        paths = sorted((self.folder / output).glob("checkpoint_*.h5"))
        self.assertGreater(len(paths), 0)
        for path in paths:
            self.assertIn("content   intact\n", self.succeed("info", path).output)
